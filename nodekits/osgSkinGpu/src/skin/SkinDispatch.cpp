// SPDX-License-Identifier: MIT
#include "skin/SkinDispatch.h"

#include "shader/ComputeProgram.h"
#include "skin/SharedBarrier.h"

#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/State>

namespace osgSkin {
namespace {

std::atomic<unsigned int>& dispatches() {
    static std::atomic<unsigned int> count{0};
    return count;
}

} // namespace

SkinDispatch::SkinDispatch(const osg::ref_ptr<const GpuModel>& model) : _model(model) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
}

unsigned int SkinDispatch::count() {
    return dispatches();
}

void SkinDispatch::drawImplementation(osg::RenderInfo& renderInfo) const {
    osg::State& state = *renderInfo.getState();
    const unsigned int id = state.getContextID();
    if (id >= kMostContexts || isDone(id)) return;
    const unsigned int pose = _pose;
    const auto* extensions = state.get<osg::GLExtensions>();
    if (!state.getLastAppliedProgramObject() || !canReadTexels(id, _model->texelCount())) {
        OSG_WARN << "osgSkin: this driver cannot run the compute shader or read a skin of "
                 << _model->texelCount() << " texels; the processor deforms" << std::endl;
        noteCannotCompute(id);
        return;
    }
    const auto vertices = static_cast<unsigned int>(_model->model().vertexCount());
    extensions->glDispatchCompute((vertices + kComputeThreads - 1) / kComputeThreads, 1, 1);
    // Our buffers came to be bound as vertex buffers while they were filled; OSG does not know.
    state.unbindVertexBufferObject();
    extensions->glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    SharedBarrier::instance().need(id);
    _done[id] = pose;
    ++dispatches();
}

void SkinDispatch::releaseGLObjects(osg::State* state) const {
    osg::Drawable::releaseGLObjects(state);
    for (unsigned int id = 0; id < kMostContexts; ++id)
        if (!state || state->getContextID() == id) _done[id] = 0;
}

} // namespace osgSkin
