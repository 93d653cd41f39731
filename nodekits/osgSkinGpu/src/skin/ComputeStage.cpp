// SPDX-License-Identifier: MIT
#include "skin/ComputeStage.h"

#include <osg/ContextData>
#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/State>

#include <array>
#include <atomic>

#ifndef GL_MAX_TEXTURE_BUFFER_SIZE
#define GL_MAX_TEXTURE_BUFFER_SIZE 0x8C2B
#endif
#ifndef GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT
#define GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT 0x00000001
#endif
#ifndef GL_BUFFER_UPDATE_BARRIER_BIT
#define GL_BUFFER_UPDATE_BARRIER_BIT 0x00000200
#endif

namespace osgSkin {
namespace {

/// Facts about contexts by their numbers.
struct ContextFacts {
    std::atomic<bool> hasFailed{false};
    std::atomic<GLint> mostTexels{0}; ///< 0: not asked yet
};

std::array<ContextFacts, kMaxContexts>& facts() {
    static std::array<ContextFacts, kMaxContexts> contexts;
    return contexts;
}

/// Forgets the facts about a context when it closes: the next one may have its number.
class ForgetFacts : public osg::GraphicsObjectManager {
public:
    explicit ForgetFacts(unsigned int contextId)
        : osg::GraphicsObjectManager("osgSkin", contextId) {}
    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override { forget(); }
    void discardAllGLObjects() override { forget(); }

private:
    void forget() const {
        facts()[_contextID].hasFailed = false;
        facts()[_contextID].mostTexels = 0;
    }
};

} // namespace

osg::ref_ptr<osg::Program> SharedProgram::get() {
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::ref_ptr<osg::Program> program;
    if (!_program.lock(program)) {
        program = _make();
        _program = program;
    }
    return program;
}

bool canCompute(const osg::State& state) {
    const unsigned int id = state.getContextID();
    if (id >= kMaxContexts || facts()[id].hasFailed) return false;
    // Finding the extensions needs the context; known ones may be read by any thread.
    const osg::GLExtensions* extensions = osg::GLExtensions::Get(id, false);
    // A driver without compute shaders may still have their functions.
    return extensions && extensions->glslLanguageVersion >= 4.3f &&
           osg::isGLExtensionOrVersionSupported(id, "GL_ARB_compute_shader", 4.3f) &&
           osg::isGLExtensionOrVersionSupported(id, "GL_ARB_shader_storage_buffer_object", 4.3f) &&
           extensions->glDispatchCompute && extensions->glMemoryBarrier;
}

void noteCannotCompute(unsigned int contextId) {
    if (contextId >= kMaxContexts) return;
    osg::get<ForgetFacts>(contextId);
    facts()[contextId].hasFailed = true;
}

bool canReadTexels(unsigned int contextId, std::size_t texels) {
    const bool isKept = contextId < kMaxContexts;
    GLint most = isKept ? facts()[contextId].mostTexels.load() : 0;
    if (most == 0) { // asking may be slow
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
        if (isKept) {
            osg::get<ForgetFacts>(contextId);
            facts()[contextId].mostTexels = most;
        }
    }
    return most > 0 && texels <= static_cast<std::size_t>(most);
}

SharedBarrier& SharedBarrier::instance() {
    // Never deleted: contexts may be gone when a process ends.
    static const auto& barrier = *new osg::ref_ptr<SharedBarrier>(new SharedBarrier);
    return *barrier;
}

SharedBarrier::SharedBarrier() : _place(new osg::StateSet) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setUpBin(*_place, kBarrierBin);
}

void SharedBarrier::addTo(osgUtil::CullVisitor& cv) {
    addToStage(cv, *this, *_place);
}

void SharedBarrier::drawImplementation(osg::RenderInfo& renderInfo) const {
    const unsigned int id = renderInfo.getContextID();
    if (id >= kMaxContexts || !_needed[id].exchange(false)) return;
    // For vertex fetches, and applications that read buffers back.
    renderInfo.getState()->get<osg::GLExtensions>()->glMemoryBarrier(
        GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    ++_count;
}

void setUpBin(osg::StateSet& state, ComputeBin bin) {
    state.setRenderBinDetails(bin, "RenderBin", osg::StateSet::PROTECTED_RENDERBIN_DETAILS);
    state.setNestRenderBins(false);
}

void addToStage(osgUtil::CullVisitor& cv, osg::Drawable& drawable, osg::StateSet& state) {
    cv.pushStateSet(&state);
    cv.addDrawable(&drawable, cv.getModelViewMatrix());
    cv.popStateSet();
}

} // namespace osgSkin
