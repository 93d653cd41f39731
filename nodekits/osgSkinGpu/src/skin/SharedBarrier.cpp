// SPDX-License-Identifier: MIT
#include "skin/SharedBarrier.h"

#include <osg/GLExtensions>
#include <osg/State>

#ifndef GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT
#define GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT 0x00000001
#endif
#ifndef GL_BUFFER_UPDATE_BARRIER_BIT
#define GL_BUFFER_UPDATE_BARRIER_BIT 0x00000200
#endif

namespace osgSkin {

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
    if (id >= kMostContexts || !_needed[id].exchange(false)) return;
    // Vertex fetches read what was computed; so may an application that reads buffers back.
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
