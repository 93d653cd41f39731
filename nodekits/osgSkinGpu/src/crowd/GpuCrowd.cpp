// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuCrowd>

#include "crowd/CrowdCull.h"
#include "crowd/CrowdDraws.h"
#include "crowd/CrowdMembers.h"
#include "crowd/ListedDraws.h"
#include "shader/CrowdText.h"
#include "skin/ContextSupport.h"
#include "skin/SharedBarrier.h"

#include <osgSkin/Error>

#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/Uniform>

#include <atomic>
#include <cmath>
#include <mutex>

namespace osgSkin {

namespace {

/// Seconds of single precision: after so many, shaders count from another time. A step of it is
/// then 15 us.
constexpr double kMostSeconds = 256.0;

} // namespace

struct GpuCrowd::Inside {
    osg::ref_ptr<CrowdCharacter> character;
    std::unique_ptr<CrowdMembers> members;
    std::unique_ptr<CrowdDraws> indirect;
    osg::ref_ptr<CrowdCull> cull;
    std::unique_ptr<ListedDraws> listed;
    std::mutex mutex; ///< of bounds
    std::atomic<bool> areBoundsOld{false};
    double seconds = 0.0;
    osg::ref_ptr<osg::Uniform> time = new osg::Uniform("osgSkinTime", 0.0f);
    Culling culling = Culling::Automatic;

    void rebuild(const std::vector<CrowdInstance>& instances) {
        listed = nullptr;
        members = std::make_unique<CrowdMembers>(*character, instances, seconds);
        listed = std::make_unique<ListedDraws>(*character, *members);
        indirect =
            std::make_unique<CrowdDraws>(*character, instances.size(), CrowdDraws::Count::Indirect);
        cull = new CrowdCull(*character, *indirect, members->texture());
        cull->setCount(instances.size());
        tellTime();
    }

    void tellTime() const {
        time->set(static_cast<float>(seconds - (members ? members->since() : 0.0)));
    }

    /// Takes the character's where they have grown; any thread.
    void findBounds() {
        if (!areBoundsOld || !members) return;
        const std::lock_guard<std::mutex> lock(mutex);
        if (!areBoundsOld) return;
        members->findSpheres();
        cull->setBounds(character->bounds());
        indirect->setBound(members->box());
        areBoundsOld = false;
    }
};

GpuCrowd::GpuCrowd(CrowdCharacter* character) : _inside(std::make_unique<Inside>()) {
    _inside->character = character; // first: what is refused is let go, too
    if (!character || character->parts().empty() || !character->skins().front().clips)
        throw Error("crowd: expected a character with a skin and a clip");
    osg::StateSet& state = *getOrCreateStateSet();
    // Times and members change while a draw thread may still read those of the frame before.
    state.setDataVariance(osg::Object::DYNAMIC);
    state.setAttribute(plainCrowdProgram());
    state.setDefine("OSGSKIN");
    state.addUniform(new osg::Uniform("osgSkinModel", static_cast<int>(kCrowdModelUnit)));
    state.addUniform(new osg::Uniform("osgSkinClips", static_cast<int>(kCrowdClipUnit)));
    state.addUniform(new osg::Uniform("osgSkinInstances", static_cast<int>(kCrowdInstanceUnit)));
    state.addUniform(new osg::Uniform("osgSkinVisible", static_cast<int>(kCrowdVisibleUnit)));
    state.addUniform(new osg::Uniform("osgSkinImage", 0));
    state.addUniform(_inside->time);
    character->addCrowd(*this);
}

GpuCrowd::GpuCrowd(const GpuCrowd& other, const osg::CopyOp& copyop)
    : osg::Node(other, copyop), _inside(std::make_unique<Inside>()) {
    const Inside& from = *other._inside;
    _inside->character = from.character;
    _inside->culling = from.culling;
    _inside->seconds = from.seconds;
    // Its members and their time are its own.
    setStateSet(new osg::StateSet(*other.getStateSet(), osg::CopyOp::SHALLOW_COPY));
    getStateSet()->addUniform(_inside->time);
    from.character->addCrowd(*this);
    if (from.members) setInstances(from.members->instances());
}

GpuCrowd::~GpuCrowd() = default;

void GpuCrowd::setInstances(const std::vector<CrowdInstance>& instances) {
    Inside& in = *_inside;
    checkMembers(*in.character, instances);
    if (in.members && in.members->size() == instances.size()) {
        in.members->set(instances);
    } else {
        in.rebuild(instances);
        getOrCreateStateSet()->setTextureAttribute(kCrowdInstanceUnit, in.members->texture());
    }
    in.indirect->setBound(in.members->box());
    dirtyBound();
}

std::size_t GpuCrowd::getInstanceCount() const {
    return _inside->members ? _inside->members->size() : 0;
}

void GpuCrowd::setTime(double seconds) {
    if (!std::isfinite(seconds)) return;
    Inside& in = *_inside;
    in.seconds = seconds;
    if (in.members && std::abs(seconds - in.members->since()) > kMostSeconds)
        in.members->setSince(seconds);
    in.tellTime();
}

void GpuCrowd::boundsChanged() {
    _inside->areBoundsOld = true;
    dirtyBound();
}

void GpuCrowd::setCulling(Culling culling) {
    _inside->culling = culling;
}

void GpuCrowd::traverse(osg::NodeVisitor& nv) {
    osgUtil::CullVisitor* cv = nv.asCullVisitor();
    Inside& in = *_inside;
    if (!cv || !cv->getState() || getInstanceCount() == 0) return;
    const osg::State& state = *cv->getState();
    const osg::GLExtensions* extensions = osg::GLExtensions::Get(state.getContextID(), false);
    if (!extensions) return; // drawn in no frame yet
    if (extensions->glslLanguageVersion < 3.3f) {
        static std::atomic<bool> isTold{false};
        if (!isTold.exchange(true))
            OSG_WARN << "osgSkin: crowds need OpenGL 3.3; nothing of them is drawn" << std::endl;
        return;
    }
    in.findBounds();
    if (in.culling == Culling::Automatic && getInstanceCount() <= CrowdCull::kMostMembers &&
        canCompute(state) && !in.cull->isIn(*cv)) {
        addToStage(*cv, *in.cull, in.cull->state());
        in.indirect->cull(*cv);
    } else {
        in.listed->cull(*cv);
    }
}

osg::BoundingSphere GpuCrowd::computeBound() const {
    _inside->findBounds();
    return _inside->members ? osg::BoundingSphere(_inside->members->box()) : osg::BoundingSphere();
}

void GpuCrowd::resizeGLObjectBuffers(unsigned int maxSize) {
    osg::Node::resizeGLObjectBuffers(maxSize);
    if (!_inside->members) return;
    _inside->indirect->resizeGLObjectBuffers(maxSize);
    _inside->cull->state().resizeGLObjectBuffers(maxSize);
    _inside->listed->resizeGLObjectBuffers(maxSize);
}

void GpuCrowd::releaseGLObjects(osg::State* state) const {
    osg::Node::releaseGLObjects(state);
    if (!_inside->members) return;
    _inside->indirect->releaseGLObjects(state);
    _inside->cull->state().releaseGLObjects(state);
    _inside->listed->releaseGLObjects(state);
}

osg::ref_ptr<osg::Shader> crowdVertexShader() {
    return new osg::Shader(osg::Shader::VERTEX, crowdText());
}

} // namespace osgSkin
