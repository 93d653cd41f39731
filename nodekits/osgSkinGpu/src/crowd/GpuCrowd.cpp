// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuCrowd>

#include "crowd/CrowdCull.h"
#include "crowd/CrowdDraws.h"
#include "crowd/CrowdMembers.h"
#include "crowd/CrowdView.h"
#include "shader/CrowdText.h"
#include "skin/ContextSupport.h"
#include "skin/SharedBarrier.h"

#include <osgSkin/Error>

#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/Uniform>

#include <atomic>
#include <mutex>

namespace osgSkin {

struct GpuCrowd::Inside {
    /// Draws whose list the processor fills, for one camera in one frame.
    struct Listed {
        CrowdDraws draws;
        unsigned int frame; ///< in which it was last drawn
    };

    osg::ref_ptr<CrowdCharacter> character;
    std::unique_ptr<CrowdMembers> members;
    std::unique_ptr<CrowdDraws> indirect;
    osg::ref_ptr<CrowdCull> cull;
    std::mutex mutex;
    std::vector<std::unique_ptr<Listed>> listed;
    osg::ref_ptr<osg::Uniform> time = new osg::Uniform("osgSkinTime", 0.0f);
    Culling culling = Culling::Automatic;

    void rebuild(const std::vector<CrowdInstance>& instances) {
        members = std::make_unique<CrowdMembers>(instances, character->bounds());
        listed.clear();
        cull = nullptr;
        indirect =
            std::make_unique<CrowdDraws>(*character, instances.size(), CrowdDraws::Count::Indirect);
        cull = new CrowdCull(*character, *indirect, members->texture());
        cull->setCount(instances.size());
    }

    /// Draws that no draw thread can still be reading: no cull begins before the draw of the frame
    /// before the last one has ended.
    CrowdDraws& freeDraws(unsigned int frame) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const std::unique_ptr<Listed>& old : listed)
            if (old->frame + 2 <= frame) {
                old->frame = frame;
                return old->draws;
            }
        listed.push_back(std::make_unique<Listed>(
            Listed{CrowdDraws(*character, members->size(), CrowdDraws::Count::Direct), frame}));
        return listed.back()->draws;
    }

    void list(const CrowdView& view, CrowdDraws& draws) const {
        const std::vector<osg::Vec4f>& spheres = members->spheres();
        std::vector<std::size_t> counts(character->levelCount(), 0);
        osg::UIntArray& places = draws.list();
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            if (!view.sees(spheres[i])) continue;
            const std::size_t level = view.levelOf(spheres[i], character->levelSizes());
            places[level * spheres.size() + counts[level]++] = static_cast<GLuint>(i);
        }
        places.dirty();
        for (std::size_t level = 0; level < counts.size(); ++level)
            draws.setCount(level, counts[level]);
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
    state.addUniform(_inside->time);
    state.addUniform(new osg::Uniform("osgSkinModel", static_cast<int>(kCrowdModelUnit)));
    state.addUniform(new osg::Uniform("osgSkinClips", static_cast<int>(kCrowdClipUnit)));
    state.addUniform(new osg::Uniform("osgSkinInstances", static_cast<int>(kCrowdInstanceUnit)));
    state.addUniform(new osg::Uniform("osgSkinVisible", static_cast<int>(kCrowdVisibleUnit)));
    state.addUniform(new osg::Uniform("osgSkinImage", 0));
}

GpuCrowd::~GpuCrowd() = default;

void GpuCrowd::setInstances(const std::vector<CrowdInstance>& instances) {
    Inside& in = *_inside;
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
    _inside->time->set(static_cast<float>(seconds));
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
    if (in.culling == Culling::Automatic && canCompute(state)) {
        addToStage(*cv, *in.cull, in.cull->state());
        in.indirect->cull(*cv);
        return;
    }
    const osg::FrameStamp* stamp = nv.getFrameStamp();
    CrowdDraws& draws = in.freeDraws(stamp ? stamp->getFrameNumber() : 0);
    in.list(CrowdView(*cv->getModelViewMatrix(), *cv->getProjectionMatrix()), draws);
    draws.setBound(in.members->box());
    draws.cull(*cv);
}

osg::BoundingSphere GpuCrowd::computeBound() const {
    return _inside->members ? osg::BoundingSphere(_inside->members->box()) : osg::BoundingSphere();
}

void GpuCrowd::resizeGLObjectBuffers(unsigned int maxSize) {
    osg::Node::resizeGLObjectBuffers(maxSize);
    if (_inside->indirect) _inside->indirect->resizeGLObjectBuffers(maxSize);
    if (_inside->cull) _inside->cull->state().resizeGLObjectBuffers(maxSize);
    for (const auto& listed : _inside->listed) listed->draws.resizeGLObjectBuffers(maxSize);
}

void GpuCrowd::releaseGLObjects(osg::State* state) const {
    osg::Node::releaseGLObjects(state);
    if (_inside->indirect) _inside->indirect->releaseGLObjects(state);
    if (_inside->cull) _inside->cull->state().releaseGLObjects(state);
    for (const auto& listed : _inside->listed) listed->draws.releaseGLObjects(state);
}

osg::ref_ptr<osg::Shader> crowdVertexShader() {
    return new osg::Shader(osg::Shader::VERTEX, crowdText());
}

} // namespace osgSkin
