// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuCrowd>

#include "crowd/CrowdDraws.h"
#include "crowd/CrowdText.h"
#include "crowd/CrowdView.h"
#include "model/PackTexels.h"
#include "skin/ComputeStage.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <osg/BufferIndexBinding>
#include <osg/BufferObject>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/State>
#include <osg/Uniform>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#ifndef GL_COMMAND_BARRIER_BIT
#define GL_COMMAND_BARRIER_BIT 0x00000040
#endif
#ifndef GL_SHADER_STORAGE_BARRIER_BIT
#define GL_SHADER_STORAGE_BARRIER_BIT 0x00002000
#endif
#ifndef GL_TEXTURE_FETCH_BARRIER_BIT
#define GL_TEXTURE_FETCH_BARRIER_BIT 0x00000008
#endif

namespace osgSkin {
namespace {

/// Shaders count seconds in single precision, from a time that moves on after this many; their
/// steps are then at most 15 us.
constexpr double kMaxSeconds = 256.0;
constexpr float kLargestScale = 1e9f; ///< as in a Pose

unsigned int bitsOf(double number) {
    const auto rounded = static_cast<float>(number);
    unsigned int word;
    std::memcpy(&word, &rounded, sizeof word);
    return word;
}

unsigned int byteOf(float share) {
    return static_cast<unsigned int>(std::lround(std::clamp(share, 0.0f, 1.0f) * 255.0f));
}

/// Whether all are finite in single precision, which shaders use.
bool areFinite(std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](double x) { return std::isfinite(static_cast<float>(x)); });
}

/// Whether every vertex and sphere of the member stays finite.
bool isPlaceable(const CrowdInstance& one) {
    const glm::dvec3 position(one.position.x(), one.position.y(), one.position.z());
    return isInRange(position) && std::abs(one.scale) <= kLargestScale &&
           std::abs(one.rotation.length2() - 1.0) <= 0.02; // false for NaN
}

bool isPlayable(const CrowdInstance& one) {
    const osg::Vec4d colour(one.colour);
    return areFinite({one.phase, double(one.speed), one.otherPhase, double(one.otherSpeed),
                      colour.x(), colour.y(), colour.z(), colour.w()}) &&
           one.blend >= 0.0f && one.blend <= 1.0f;
}

/// \throw osgSkin::Error as GpuCrowd::setInstances()
void checkMembers(const CrowdCharacter& character, const std::vector<CrowdInstance>& instances) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const CrowdInstance& one = instances[i];
        const std::string label = "crowd: member " + std::to_string(i);
        for (const unsigned int clip : {one.clip, one.blend != 0.0f ? one.otherClip : 0u})
            if (clip >= character.clipCount())
                throw Error(label + " plays clip " + std::to_string(clip) +
                            ", expected less than " + std::to_string(character.clipCount()));
        if (!isPlaceable(one))
            throw Error(label +
                        " is beyond 1e18, scaled by more than 1e9 or has a rotation that is "
                        "not a unit quaternion");
        if (!isPlayable(one))
            throw Error(label + " has a number that is not finite, or a blend outside 0..1");
    }
}

/// The members of a crowd, for shaders and for culling on the processor.
class CrowdMembers {
public:
    /// \param character must outlive this
    /// \param since the time that shaders count from, seconds
    CrowdMembers(const CrowdCharacter& character, const std::vector<CrowdInstance>& instances,
                 double since)
        : _character(character), _since(since), _texels(new osg::Vec4uiArray) {
        _texels->resize(std::max<std::size_t>(1, instances.size()) * CrowdInstance::kTexels);
        _texture = textureOf(*_texels, GL_RGBA32UI_EXT, GL_DYNAMIC_DRAW_ARB);
        set(instances);
    }

    std::size_t size() const { return _instances.size(); }
    osg::TextureBuffer* texture() const { return _texture.get(); }
    const std::vector<CrowdInstance>& instances() const { return _instances; }
    /// \param instances as many as before
    void set(const std::vector<CrowdInstance>& instances) {
        _instances = instances;
        pack();
        findSpheres();
    }

    double since() const { return _since; }
    void setSince(double seconds) {
        _since = seconds;
        pack();
    }

    /// Updates spheres and box from the character's bounds.
    void findSpheres() {
        const osg::Vec3d centre = _character.bounds().center();
        const float radius = _character.bounds().radius();
        _spheres.clear();
        _box.init();
        for (const CrowdInstance& one : _instances) {
            const osg::Vec3f place(one.position + one.rotation * (centre * double(one.scale)));
            _spheres.emplace_back(place, radius * std::abs(one.scale));
            _box.expandBy(osg::BoundingSphere(place, _spheres.back().w()));
        }
    }
    const std::vector<osg::Vec4f>& spheres() const { return _spheres; } ///< centre, radius
    const osg::BoundingBox& box() const { return _box; }                ///< around all spheres

private:
    double phaseOf(unsigned int clip, double phase, float speed) const {
        const double at = phase + double(speed) * _since;
        const double loop = clip < _character.clipCount() ? _character.loopSeconds(clip) : 0.0;
        return loop > 0.0 ? at - loop * std::floor(at / loop) : at;
    }
    void pack() {
        for (std::size_t i = 0; i < _instances.size(); ++i) {
            CrowdInstance one = _instances[i];
            one.phase = phaseOf(one.clip, one.phase, one.speed);
            one.otherPhase = phaseOf(one.otherClip, one.otherPhase, one.otherSpeed);
            one.pack(&(*_texels)[i * CrowdInstance::kTexels]);
        }
        _texels->dirty();
    }

    const CrowdCharacter& _character;
    std::vector<CrowdInstance> _instances;
    double _since;
    osg::ref_ptr<osg::Vec4uiArray> _texels;
    osg::ref_ptr<osg::TextureBuffer> _texture;
    std::vector<osg::Vec4f> _spheres;
    osg::BoundingBox _box;
};

/// Draws of a crowd culled on the processor: one set of draws for each cull, kept until drawn.
class ListedDraws {
public:
    /// \param character must outlive this, as must the members
    ListedDraws(const CrowdCharacter& character, const CrowdMembers& members)
        : _character(character), _members(members), _levels(character) {}

    /// Lists the visible members and adds their draws to a cull; thread-safe.
    /// \param maxTriangles 0: no limit
    void cull(osgUtil::CullVisitor& cv, unsigned int maxTriangles) {
        Listed& listed = take();
        list(CrowdView(*cv.getModelViewMatrix(), *cv.getProjectionMatrix()), maxTriangles, listed);
        listed.draws.setBound(_members.box());
        listed.draws.cull(cv);
        const std::lock_guard<std::mutex> lock(_mutex);
        listed.isTaken = false;
    }

    void resizeGLObjectBuffers(unsigned int maxSize) {
        for (const std::unique_ptr<Listed>& listed : _all)
            listed->draws.resizeGLObjectBuffers(maxSize);
    }
    void releaseGLObjects(osg::State* state) const {
        for (const std::unique_ptr<Listed>& listed : _all) listed->draws.releaseGLObjects(state);
    }

private:
    struct Listed {
        CrowdDraws draws;
        bool isTaken; ///< by a cull that is still adding them
        std::vector<GLuint> seen;
        std::vector<float> sizes; ///< of those, see CrowdView::sizeOf()
    };

    Listed& take() {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const std::unique_ptr<Listed>& old : _all)
            if (!old->isTaken && old->draws.isFree()) {
                old->isTaken = true;
                return *old;
            }
        _all.push_back(std::make_unique<Listed>(Listed{
            CrowdDraws(_character, _members.size(), CrowdDraws::Count::Direct), true, {}, {}}));
        return *_all.back();
    }
    void list(const CrowdView& view, unsigned int maxTriangles, Listed& listed) const {
        const std::vector<osg::Vec4f>& spheres = _members.spheres();
        listed.seen.clear();
        listed.sizes.clear();
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            if (!view.sees(spheres[i])) continue;
            listed.seen.push_back(static_cast<GLuint>(i));
            listed.sizes.push_back(view.sizeOf(spheres[i]));
        }
        const int steps = maxTriangles > 0 ? _levels.stepsFor(listed.sizes, maxTriangles) : 0;
        std::vector<std::size_t> counts(_character.levelCount(), 0);
        osg::UIntArray& places = listed.draws.list();
        for (std::size_t i = 0; i < listed.seen.size(); ++i) {
            const std::size_t level = _levels.levelOf(listed.sizes[i], steps);
            places[level * spheres.size() + counts[level]++] = listed.seen[i];
        }
        places.dirty();
        for (std::size_t level = 0; level < counts.size(); ++level)
            listed.draws.setCount(level, counts[level]);
    }

    const CrowdCharacter& _character;
    const CrowdMembers& _members;
    CrowdLevels _levels;
    std::mutex _mutex;
    std::vector<std::unique_ptr<Listed>> _all;
};

/// Culls on the graphics card: when drawn, fills the commands and the list of a crowd's indirect
/// draws for the current camera.
class CrowdCull : public osg::Drawable {
public:
    CrowdCull(const CrowdCharacter& character, const CrowdDraws& draws,
              osg::TextureBuffer* instances)
        : _commands(draws.commands()), _levels(character),
          _fit(new osg::UIntArray(1 + kMaxLevels + CrowdLevels::kBins)),
          _parts(static_cast<int>(character.parts().size())),
          _capacity(static_cast<int>(draws.list().size() / character.levelCount())),
          _state(new osg::StateSet) {
        setUseDisplayList(false);
        setSupportsDisplayList(false);
        const auto ours = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE |
                          osg::StateAttribute::PROTECTED;
        setBounds(character.bounds());
        setUpBin(*_state, kComputeBin);
        _state->setAttribute(cullProgram(), ours);
        _state->setTextureAttribute(kCrowdInstanceUnit, instances, ours);
        _state->addUniform(
            new osg::Uniform("osgSkinInstances", static_cast<int>(kCrowdInstanceUnit)), ours);
        _state->setAttribute(new osg::ShaderStorageBufferBinding(kCommandBuffer, _commands), ours);
        _state->setAttribute(new osg::ShaderStorageBufferBinding(kVisibleBuffer, &draws.list()),
                             ours);
        // Not a vertex buffer, which OSG would leave bound for the arrays of the next drawable.
        const osg::ref_ptr<osg::ShaderStorageBufferObject> buffer =
            new osg::ShaderStorageBufferObject;
        buffer->setUsage(GL_DYNAMIC_COPY_ARB);
        _fit->setBufferObject(buffer);
        _state->setAttribute(new osg::ShaderStorageBufferBinding(kFitBuffer, _fit), ours);
    }

    /// The most that one dispatch can test, in every driver.
    static constexpr std::size_t kMaxMembers = std::size_t{65535} * kCullThreads;

    osg::StateSet& state() const { return *_state; }

    /// Not while any thread draws; so setBounds().
    void setCount(std::size_t members) { _count = static_cast<int>(members); }
    /// \param count 0: no limit
    void setMaxTriangles(unsigned int count) { _maxTriangles = count; }
    /// \param bounds of a member, in its own space
    void setBounds(const osg::BoundingBox& bounds) {
        _sphere = osg::Vec4f(bounds.center(), bounds.radius());
    }

    /// Whether a cull's render stage holds this already: it has one list, so it serves one place.
    bool isIn(osgUtil::CullVisitor& cv) const {
        const auto& bins = cv.getCurrentRenderBin()->getStage()->getRenderBinList();
        const auto bin = bins.find(kComputeBin);
        if (bin == bins.end()) return false;
        for (const osgUtil::StateGraph* graph : bin->second->getStateGraphList())
            for (const auto& leaf : graph->_leaves)
                if (leaf->getDrawable() == this) return true;
        return false;
    }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    /// Writes an array into its buffer of the current context, if there is one.
    static bool reset(osg::State& state, const osg::BufferData& data);
    void dispatch(const osg::GLExtensions& gl) const {
        gl.glDispatchCompute((static_cast<GLuint>(_count) + kCullThreads - 1) / kCullThreads, 1, 1);
    }

    osg::ref_ptr<osg::DefaultIndirectCommandDrawElements> _commands;
    osg::Vec4f _sphere;
    CrowdLevels _levels;
    osg::ref_ptr<osg::UIntArray> _fit; ///< zeros; see the shader
    int _parts, _capacity, _count = 0;
    std::atomic<unsigned int> _maxTriangles{0};
    osg::ref_ptr<osg::StateSet> _state;
};

/// Compiles a crowd for OSG's compile visitors, which look for drawables and ignore shaders'
/// defines.
class CrowdCompile : public osg::Drawable {
public:
    /// \param states above the draws, the topmost first
    CrowdCompile(std::vector<osg::ref_ptr<osg::StateSet>> states,
                 std::shared_ptr<const CrowdDraws> draws, const osg::ref_ptr<CrowdCull>& cull)
        : _states(std::move(states)), _draws(std::move(draws)), _cull(cull) {
        setUseDisplayList(false);
        setUseVertexBufferObjects(true);
    }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void compileGLObjects(osg::RenderInfo& renderInfo) const override {
        osg::State& state = *renderInfo.getState();
        state.get<osg::GLExtensions>(); // canCompute() asks for known ones
        if (!canCompute(state)) return;
        for (const osg::ref_ptr<osg::StateSet>& one : _states) state.pushStateSet(one);
        _draws->compileGLObjects(renderInfo);
        state.pushStateSet(&_cull->state());
        state.apply();
        state.popStateSet();
        for (std::size_t i = 0; i < _states.size(); ++i) state.popStateSet();
        state.apply();
    }

private:
    std::vector<osg::ref_ptr<osg::StateSet>> _states;
    std::shared_ptr<const CrowdDraws> _draws;
    osg::ref_ptr<CrowdCull> _cull;
};

void CrowdCull::drawImplementation(osg::RenderInfo& renderInfo) const {
    osg::State& state = *renderInfo.getState();
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) {
        OSG_WARN << "osgSkin: this driver cannot run the culling shader; the processor culls"
                 << std::endl;
        noteCannotCompute(state.getContextID());
        return;
    }
    const unsigned int most = _maxTriangles;
    if (!reset(state, *_commands) || (most > 0 && !reset(state, *_fit))) return;

    const CrowdView view(state.getModelViewMatrix(), state.getProjectionMatrix());
    const auto at = [&](const std::string& name) {
        const GLint place = program->getUniformLocation(name);
        return place >= 0 ? place : program->getUniformLocation(name + "[0]");
    };
    gl.glUniform4fv(at("osgSkinPlanes"), 4, view.planes.front().ptr());
    gl.glUniform4fv(at("osgSkinSphere"), 1, _sphere.ptr());
    gl.glUniform4fv(at("osgSkinEye"), 1, osg::Vec4f(view.eye, view.sizeAtOne).ptr());
    gl.glUniform1i(at("osgSkinIsFlat"), view.isFlat ? 1 : 0);
    const std::vector<float>& sizes = _levels.sizes();
    const auto levels = static_cast<GLsizei>(sizes.size());
    const GLint counts[] = {_count, levels, _parts, _capacity};
    gl.glUniform4iv(at("osgSkinCounts"), 1, counts);
    gl.glUniform1fv(at("osgSkinSizes"), levels, sizes.data());
    gl.glUniform1ui(at("osgSkinMaxTriangles"), most);
    if (most > 0) {
        gl.glUniform1uiv(at("osgSkinTriangles"), levels, _levels.triangles().data());
        const GLint step = at("osgSkinStep");
        gl.glUniform1i(step, kCountSizes);
        dispatch(gl);
        gl.glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        gl.glUniform1i(step, kFitLevels);
        gl.glDispatchCompute(CrowdLevels::kBins / kCullThreads, 1, 1);
        gl.glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        gl.glUniform1i(step, kListMembers);
    }
    dispatch(gl);
    gl.glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

bool CrowdCull::reset(osg::State& state, const osg::BufferData& data) {
    const osg::GLBufferObject* buffer =
        data.getBufferObject()->getGLBufferObject(state.getContextID());
    if (!buffer) return false;
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    state.unbindVertexBufferObject();
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, buffer->getGLObjectID());
    gl.glBufferSubData(GL_ARRAY_BUFFER_ARB, 0, data.getTotalDataSize(), data.getDataPointer());
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    return true;
}

} // namespace

void CrowdInstance::pack(osg::Vec4ui* texels) const {
    texels[0] = {bitsOf(position.x()), bitsOf(position.y()), bitsOf(position.z()),
                 bitsOf(double(scale))};
    texels[1] = {bitsOf(rotation.x()), bitsOf(rotation.y()), bitsOf(rotation.z()),
                 bitsOf(rotation.w())};
    texels[2] = {bitsOf(phase), bitsOf(double(speed)), bitsOf(otherPhase),
                 bitsOf(double(otherSpeed))};
    texels[3] = {(clip & 0xffffu) | otherClip << 16, bitsOf(double(blend)),
                 byteOf(colour.x()) | byteOf(colour.y()) << 8 | byteOf(colour.z()) << 16 |
                     byteOf(colour.w()) << 24,
                 0};
}

struct GpuCrowd::Inside {
    osg::ref_ptr<CrowdCharacter> character;
    std::unique_ptr<CrowdMembers> members;
    std::shared_ptr<CrowdDraws> indirect; ///< shared with compilers that have not come to it yet
    osg::ref_ptr<CrowdCull> cull;
    std::unique_ptr<ListedDraws> listed;
    osg::ref_ptr<CrowdCompile> compile; ///< of the last compile traversal
    std::mutex mutex;                   ///< of bounds
    std::atomic<bool> areBoundsOld{false};
    double seconds = 0.0;
    osg::ref_ptr<osg::Uniform> time = new osg::Uniform("osgSkinTime", 0.0f);
    Culling culling = Culling::Automatic;
    unsigned int maxTriangles = 0;

    void rebuild(const std::vector<CrowdInstance>& instances) {
        listed = nullptr;
        compile = nullptr;
        members = std::make_unique<CrowdMembers>(*character, instances, seconds);
        listed = std::make_unique<ListedDraws>(*character, *members);
        indirect =
            std::make_shared<CrowdDraws>(*character, instances.size(), CrowdDraws::Count::Indirect);
        cull = new CrowdCull(*character, *indirect, members->texture());
        cull->setCount(instances.size());
        cull->setMaxTriangles(maxTriangles);
        updateTime();
    }

    void updateTime() const {
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
    _inside->maxTriangles = from.maxTriangles;
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
    if (in.members && std::abs(seconds - in.members->since()) > kMaxSeconds)
        in.members->setSince(seconds);
    in.updateTime();
}

void GpuCrowd::boundsChanged() {
    _inside->areBoundsOld = true;
    dirtyBound();
}

void GpuCrowd::setCulling(Culling culling) {
    _inside->culling = culling;
}

void GpuCrowd::setMaxTriangles(std::size_t count) {
    Inside& in = *_inside;
    in.maxTriangles = static_cast<unsigned int>(
        std::min<std::size_t>(count, std::numeric_limits<unsigned int>::max()));
    if (in.cull) in.cull->setMaxTriangles(in.maxTriangles);
}

void GpuCrowd::traverse(osg::NodeVisitor& nv) {
    osgUtil::CullVisitor* cv = nv.asCullVisitor();
    Inside& in = *_inside;
    if (!cv && in.members &&
        (dynamic_cast<osgUtil::GLObjectsVisitor*>(&nv) ||
         dynamic_cast<osgUtil::StateToCompile*>(&nv))) {
        std::vector<osg::ref_ptr<osg::StateSet>> states;
        for (osg::Node* node : nv.getNodePath())
            if (node->getStateSet()) states.emplace_back(node->getStateSet());
        in.compile = new CrowdCompile(std::move(states), in.indirect, in.cull);
        in.compile->accept(nv);
    }
    if (!cv || !cv->getState() || getInstanceCount() == 0) return;
    const osg::State& state = *cv->getState();
    const osg::GLExtensions* extensions = osg::GLExtensions::Get(state.getContextID(), false);
    if (!extensions) return; // drawn in no frame yet
    if (extensions->glslLanguageVersion < 3.3f) {
        static std::atomic<bool> wasReported{false};
        if (!wasReported.exchange(true))
            OSG_WARN << "osgSkin: crowds need OpenGL 3.3; nothing of them is drawn" << std::endl;
        return;
    }
    in.findBounds();
    if (in.culling == Culling::Automatic && getInstanceCount() <= CrowdCull::kMaxMembers &&
        canCompute(state) && !in.cull->isIn(*cv)) {
        addToStage(*cv, *in.cull, in.cull->state());
        in.indirect->cull(*cv);
    } else {
        in.listed->cull(*cv, in.maxTriangles);
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
