// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuSkin>

#include "model/GpuMorphs.h"
#include "model/PackTexels.h"
#include "skin/ComputeStage.h"
#include "skin/DeformText.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/MorphTargets>
#include <osgSkinGpu/GpuModel>
#include <osgSkinGpu/GpuPalette>

#include <osg/Array>
#include <osg/BufferIndexBinding>
#include <osg/BufferObject>
#include <osg/Drawable>
#include <osg/GLExtensions>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/Program>
#include <osg/Shader>
#include <osg/State>
#include <osg/StateSet>
#include <osg/Uniform>
#include <osg/ref_ptr>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace osgSkin {
namespace {

/// The texture units and buffer indices of the compute shaders.
enum ComputeUnit { kModelUnit, kPaletteUnit, kTangentUnit, kMorphUnit };
enum ComputeBuffer { kPositionBuffer, kNormalBuffer, kTangentBuffer };

constexpr unsigned int kComputeThreads = 64;

const char* const kMain = R"(
uniform samplerBuffer osgSkinPalette;

vec4 osgSkin_palette(int texel) {
  return texelFetch(osgSkinPalette, texel);
}

vec4 osgSkin_rotation(int joint) {
  return osgSkin_palette(4 * joint);
}

void osgSkin_anchor(int joint, inout vec3 x, inout vec3 n, inout vec3 t) {
  osgSkin_follow(joint, x, n, t);
}

#ifdef OSGSKIN_MORPHS
uniform bool osgSkinIsMorphed;
uniform usamplerBuffer osgSkinMorphs; // see GpuMorphs

vec3 osgSkin_offset(int texel) {
  return uintBitsToFloat(texelFetch(osgSkinMorphs, texel).xyz);
}

void osgSkin_morph(int vertex, vec3 n, inout vec3 x, inout vec3 tilt, inout vec3 t) {
  if (!osgSkinIsMorphed) return;
  int stride = int(texelFetch(osgSkinMorphs, 0).x);
  ivec2 entries = ivec2(texelFetch(osgSkinMorphs, 1 + vertex).xy);
  int weights = int(osgSkin_words(0).w); // behind the pose, four a texel
  vec3 move = vec3(0.0), d = vec3(0.0);
  for (int i = 0; i < entries.y; ++i) {
    int texel = entries.x + stride * i;
    int target = int(texelFetch(osgSkinMorphs, texel).w);
    float weight = osgSkin_palette(weights + (target >> 2))[target & 3];
    move += weight * osgSkin_offset(texel);
    d += weight * osgSkin_offset(texel + 1);
    if (stride > 2) t += weight * osgSkin_offset(texel + 2);
  }
  x += move;
  float along = dot(d, n);
  tilt += (d - along * n) / max(1.0 + along, 0.05);
}
#endif

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer OsgSkinPositions { float osgSkinPositions[]; };
layout(std430, binding = 1) writeonly buffer OsgSkinNormals { float osgSkinNormals[]; };
#ifdef OSGSKIN_TANGENTS
uniform samplerBuffer osgSkinTangents;
layout(std430, binding = 2) writeonly buffer OsgSkinPosedTangents { vec4 osgSkinPosedTangents[]; };
#endif

void main() {
  int vertex = int(gl_GlobalInvocationID.x);
  if (vertex >= int(osgSkin_words(0).z)) return;
  vec3 position, normal;
#ifdef OSGSKIN_TANGENTS
  vec4 rest = texelFetch(osgSkinTangents, vertex);
  vec3 tangent = rest.xyz;
#else
  vec3 tangent = vec3(0.0);
#endif
  osgSkin_deform(vertex, position, normal, tangent);
  for (int i = 0; i < 3; ++i) {
    osgSkinPositions[3 * vertex + i] = position[i];
    osgSkinNormals[3 * vertex + i] = normal[i];
  }
#ifdef OSGSKIN_TANGENTS
  osgSkinPosedTangents[vertex] = vec4(tangent, rest.w);
#endif
}
)";

osg::ref_ptr<osg::Program> make(const char* name, const char* defines) {
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName(name);
    program->addShader(new osg::Shader(osg::Shader::COMPUTE, std::string("#version 430\n") +
                                                                 defines + deformText() + kMain));
    return program;
}

/// Deforms the vertices of a skin, one per thread; shared by all skins.
///
/// \param withTangents reads osgSkinTangents and writes tangents, too
/// \param withMorphs reads osgSkinMorphs, too
osg::ref_ptr<osg::Program> computeProgram(bool withTangents, bool withMorphs) {
    static SharedProgram programs[] = {
        SharedProgram([] { return make("osgSkin deform", ""); }), SharedProgram([] {
            return make("osgSkin deform with tangents", "#define OSGSKIN_TANGENTS\n");
        }),
        SharedProgram(
            [] { return make("osgSkin deform with morphs", "#define OSGSKIN_MORPHS\n"); }),
        SharedProgram([] {
            return make("osgSkin deform with both",
                        "#define OSGSKIN_TANGENTS\n#define OSGSKIN_MORPHS\n");
        })};
    return programs[(withTangents ? 1u : 0u) + (withMorphs ? 2u : 0u)].get();
}

std::atomic<unsigned int>& dispatches() {
    static std::atomic<unsigned int> count{0};
    return count;
}

/// Computes a skin's vertices when drawn, once per pose and context.
class SkinDispatch : public osg::Drawable {
public:
    /// \param texels of the largest buffer that the shader reads
    SkinDispatch(const osg::ref_ptr<const GpuModel>& model, std::size_t texels)
        : _model(model), _texels(texels) {
        setUseDisplayList(false);
        setSupportsDisplayList(false);
    }

    /// Sets a new pose for the next draw. Not while any thread draws.
    void setPose(unsigned int number) { _pose = number; }

    /// Runs the shader for a few vertices, which the first pose overwrites: drivers translate it at
    /// its first use.
    void warmUp(osg::State& state) const {
        if (!state.getLastAppliedProgramObject()) return;
        state.get<osg::GLExtensions>()->glDispatchCompute(1, 1, 1);
        unbindBuffers(state);
    }

    bool isDone(unsigned int contextId) const { return _done[contextId] == _pose; }

    static unsigned int count() { return dispatches(); }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override {
        osg::State& state = *renderInfo.getState();
        const unsigned int id = state.getContextID();
        if (id >= kMaxContexts || isDone(id)) return;
        const unsigned int pose = _pose;
        const auto* extensions = state.get<osg::GLExtensions>();
        if (!state.getLastAppliedProgramObject() || !canReadTexels(id, _texels)) {
            OSG_WARN << "osgSkin: this driver cannot run the compute shader or read a skin of "
                     << _texels << " texels; the processor deforms" << std::endl;
            noteCannotCompute(id);
            return;
        }
        const auto vertices = static_cast<unsigned int>(_model->model().vertexCount());
        extensions->glDispatchCompute((vertices + kComputeThreads - 1) / kComputeThreads, 1, 1);
        unbindBuffers(state);
        SharedBarrier::instance().need(id);
        _done[id] = pose;
        ++dispatches();
    }
    void releaseGLObjects(osg::State* state) const override {
        osg::Drawable::releaseGLObjects(state);
        for (unsigned int id = 0; id < kMaxContexts; ++id)
            if (!state || state->getContextID() == id) _done[id] = 0;
    }

private:
    /// Filling our buffers bound them as vertex buffers, behind OSG's back.
    static void unbindBuffers(osg::State& state) {
        state.unbindVertexBufferObject();
        state.get<osg::GLExtensions>()->glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    }

    osg::ref_ptr<const GpuModel> _model;
    std::size_t _texels;
    std::atomic<unsigned int> _pose{0};
    mutable std::array<std::atomic<unsigned int>, kMaxContexts> _done{};
};

/// States above a skin must not affect its dispatch.
constexpr osg::StateAttribute::GLModeValue kOurs =
    osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

/// Gives an array a buffer object of its own, so that it starts at offset 0.
void ownBuffer(osg::Array& array, GLenum usage) {
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    buffer->setUsage(usage);
    array.setVertexBufferObject(buffer);
}

osg::ref_ptr<osg::Vec4Array> restTangents(const osg::Array& from) {
    osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
    if (const auto* four = dynamic_cast<const osg::Vec4Array*>(&from))
        tangents->asVector() = four->asVector();
    else if (const auto* three = dynamic_cast<const osg::Vec3Array*>(&from))
        for (const osg::Vec3& t : *three) tangents->push_back(osg::Vec4(t, 1.0f));
    return tangents;
}

/// The buffers and states to compute and draw one pose of a skin.
class SkinSlot {
public:
    /// \param model the skin's
    SkinSlot(const DeformableSkin& skin, const osg::ref_ptr<const GpuModel>& model)
        : _geometry(skin.makeDrawnGeometry()),
          _palette(new osg::Vec4Array(static_cast<unsigned int>(model->paletteSize()))),
          _state(new osg::StateSet) {
        const int attribute = skin.getTangentAttribute();
        const MorphTargets* const targets = skin.getMorphTargets();
        std::size_t texels = model->texelCount();
        setUpBin(*_state, kComputeBin);
        _state->setAttribute(computeProgram(attribute >= 0, targets), kOurs);
        addInput(kModelUnit, "osgSkinModel", model->texture());
        addInput(kPaletteUnit, "osgSkinPalette",
                 textureOf(*_palette, GL_RGBA32F_ARB, GL_STREAM_DRAW_ARB));
        addOutput(kPositionBuffer, *_geometry->getVertexArray());
        addOutput(kNormalBuffer, *_geometry->getNormalArray());
        if (targets) {
            _palette->resize(_palette->size() + (targets->targets().size() + 3) / 4);
            _morphs = GpuMorphs::of(*targets);
            addInput(kMorphUnit, "osgSkinMorphs", _morphs->texture());
            texels = std::max(texels, _morphs->texelCount());
            _isMorphed = new osg::Uniform("osgSkinIsMorphed", false);
            _state->addUniform(_isMorphed, kOurs);
        }
        _dispatch = new SkinDispatch(model, texels);
        if (attribute < 0) return;
        const auto index = static_cast<unsigned int>(attribute);
        const osg::ref_ptr<osg::Vec4Array> rest =
            restTangents(*skin.getRestGeometry()->getVertexAttribArray(index));
        addInput(kTangentUnit, "osgSkinTangents", textureOf(*rest, GL_RGBA32F_ARB));
        addOutput(kTangentBuffer, *_geometry->getVertexAttribArray(index));
    }

    /// Sets the pose and the morph weights that the next draw computes.
    void setPose(const GpuModel& model, const DeformableSkin& skin, unsigned int number) {
        writePalette(model, skin.getPose(), _palette->asVector().data());
        if (_morphs) writeMorphs(skin, _palette->asVector().data() + model.paletteSize());
        _palette->dirty();
        _dispatch->setPose(number);
    }

    osg::Geometry& geometry() const { return *_geometry; }
    SkinDispatch& dispatch() const { return *_dispatch; }
    osg::StateSet& dispatchState() const { return *_state; }

    void compileGLObjects(osg::RenderInfo& renderInfo) const {
        _geometry->compileGLObjects(renderInfo);
        osg::State& state = *renderInfo.getState();
        state.get<osg::GLExtensions>(); // canCompute() asks for known ones
        if (!canCompute(state)) return;
        state.pushStateSet(_state);
        state.apply();
        _dispatch->warmUp(state);
        state.popStateSet();
        state.apply();
    }
    void resizeGLObjectBuffers(unsigned int maxSize) {
        _geometry->resizeGLObjectBuffers(maxSize);
        _dispatch->resizeGLObjectBuffers(maxSize);
        _state->resizeGLObjectBuffers(maxSize);
    }
    void releaseGLObjects(osg::State* state) const {
        _geometry->releaseGLObjects(state);
        _dispatch->releaseGLObjects(state);
        _state->releaseGLObjects(state);
    }

private:
    /// Writes how far the weights are from those at rest.
    void writeMorphs(const DeformableSkin& skin, osg::Vec4* texels) {
        _isMorphed->set(skin.isMorphed());
        const std::vector<MorphTarget>& targets = skin.getMorphTargets()->targets();
        for (unsigned int i = 0; i < targets.size(); ++i)
            texels[i / 4][i % 4] = skin.shownMorphWeights()[i] - targets[i].initial;
    }

    void addOutput(unsigned int index, osg::Array& array) {
        ownBuffer(array, GL_DYNAMIC_COPY_ARB);
        _state->setAttribute(new osg::ShaderStorageBufferBinding(index, &array), kOurs);
    }
    void addInput(unsigned int unit, const char* name, osg::TextureBuffer* texture) {
        _state->setTextureAttribute(unit, texture, kOurs);
        _state->addUniform(new osg::Uniform(name, static_cast<int>(unit)), kOurs);
    }

    osg::ref_ptr<osg::Geometry> _geometry;
    osg::ref_ptr<osg::Vec4Array> _palette;
    osg::ref_ptr<const GpuMorphs> _morphs; ///< null for a skin without morph targets
    osg::ref_ptr<osg::Uniform> _isMorphed;
    osg::ref_ptr<SkinDispatch> _dispatch;
    osg::ref_ptr<osg::StateSet> _state;
};

/// Draws a skin deformed by compute shaders, see setGpu().
///
/// Two slots alternate: a draw thread may still read the one of the frame before.
class ComputeBackend : public DeformableSkin::DrawBackend {
public:
    osg::ref_ptr<DrawBackend> clone() const override { return new ComputeBackend; }
    void skinChanged(const DeformableSkin& skin) override {
        const std::lock_guard<std::mutex> lock(_mutex);
        _model = GpuModel::of(*skin.getModel());
        _slots.clear();
        // Now, rather than in one of several cull threads.
        for (int i = 0; i < 2; ++i) _slots.push_back(std::make_unique<SkinSlot>(skin, _model));
        SharedBarrier::instance();
        _current = 0;
        _isHandedOut = false;
        _isDirty = true;
    }
    void poseChanged(const DeformableSkin& skin) override {
        for (const std::unique_ptr<SkinSlot>& slot : _slots) {
            osg::Geometry& geometry = slot->geometry();
            geometry.setInitialBound(skin.getBoundingBox());
            geometry.getBound(); // now: several cull threads may ask for it at once
            if (geometry.getUseVertexArrayObject() != skin.getUseVertexArrayObject())
                geometry.setUseVertexArrayObject(skin.getUseVertexArrayObject());
        }
        _isDirty = true;
    }
    osg::Geometry* cull(const DeformableSkin& skin, osgUtil::CullVisitor& cv) override {
        const osg::State* state = cv.getState();
        if (_slots.empty() || !state || !canCompute(*state) || !skin.getUseVertexBufferObjects() ||
            cv.getComputeNearFarMode() > osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES)
            return nullptr;
        SkinSlot& slot = current(skin);
        if (!slot.dispatch().isDone(state->getContextID())) {
            addToStage(cv, slot.dispatch(), slot.dispatchState());
            SharedBarrier::instance().addTo(cv);
        }
        return &slot.geometry();
    }
    void compileGLObjects(osg::RenderInfo& renderInfo) const override {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->compileGLObjects(renderInfo);
    }
    void resizeGLObjectBuffers(unsigned int maxSize) override {
        for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->resizeGLObjectBuffers(maxSize);
    }
    void releaseGLObjects(osg::State* state) const override {
        for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->releaseGLObjects(state);
    }

private:
    SkinSlot& current(const DeformableSkin& skin) {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_isDirty) {
            // No update begins before the draw of the last frame but one has ended.
            if (_isHandedOut) _current = 1 - _current;
            _slots[_current]->setPose(*_model, skin, ++_pose);
            _isDirty = false;
        }
        _isHandedOut = true;
        return *_slots[_current];
    }

    mutable std::mutex _mutex;
    osg::ref_ptr<const GpuModel> _model;
    std::vector<std::unique_ptr<SkinSlot>> _slots;
    std::size_t _current = 0;
    unsigned int _pose = 0; ///< the number of poses given to slots
    bool _isDirty = true, _isHandedOut = false;
};

class SwitchSkins : public osg::NodeVisitor {
public:
    explicit SwitchSkins(bool on) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _on(on) {
        setNodeMaskOverride(~0u); // skins that are switched off may be switched on later
    }
    void apply(osg::Drawable& drawable) override {
        auto* skin = dynamic_cast<DeformableSkin*>(&drawable);
        if (!skin) return;
        setGpu(*skin, _on);
        ++count;
    }

    unsigned int count = 0;

private:
    bool _on;
};

} // namespace

void setGpu(DeformableSkin& skin, bool on) {
    const bool isOn = dynamic_cast<ComputeBackend*>(skin.getDrawBackend()) != nullptr;
    if (on != isOn) skin.setDrawBackend(on ? new ComputeBackend : nullptr);
}

unsigned int setGpu(osg::Node& scene, bool on) {
    SwitchSkins visitor(on);
    scene.accept(visitor);
    return visitor.count;
}

GpuCounts gpuCounts() {
    return {SkinDispatch::count(), SharedBarrier::instance().count()};
}

} // namespace osgSkin
