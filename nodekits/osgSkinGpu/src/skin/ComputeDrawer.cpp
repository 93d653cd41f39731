// SPDX-License-Identifier: MIT
#include "skin/ComputeDrawer.h"

#include "skin/SharedBarrier.h"

namespace osgSkin {

void ComputeDrawer::skinChanged(const DeformableSkin& skin) {
    const std::lock_guard<std::mutex> lock(_mutex);
    _model = GpuModel::of(*skin.getModel());
    _slots.clear();
    // Now: state sets that several cull threads share are not to be made by one of them.
    for (int i = 0; i < 2; ++i) _slots.push_back(std::make_unique<SkinSlot>(skin, _model));
    SharedBarrier::instance();
    _current = 0;
    _isHandedOut = false;
    _isDirty = true;
}

void ComputeDrawer::poseChanged(const DeformableSkin& skin) {
    for (const std::unique_ptr<SkinSlot>& slot : _slots) {
        osg::Geometry& geometry = slot->geometry();
        geometry.setInitialBound(skin.getBoundingBox());
        geometry.getBound(); // now: several cull threads may ask for it at once
        if (geometry.getUseVertexArrayObject() != skin.getUseVertexArrayObject())
            geometry.setUseVertexArrayObject(skin.getUseVertexArrayObject());
    }
    _isDirty = true;
}

SkinSlot& ComputeDrawer::current(const DeformableSkin& skin) {
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_isDirty) {
        // No update begins before the draw of the frame before the last one has ended.
        if (_isHandedOut) _current = 1 - _current;
        _slots[_current]->setPose(*_model, skin.getPose(), ++_pose);
        _isDirty = false;
    }
    _isHandedOut = true;
    return *_slots[_current];
}

osg::Geometry* ComputeDrawer::cull(const DeformableSkin& skin, osgUtil::CullVisitor& cv) {
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

void ComputeDrawer::compileGLObjects(osg::RenderInfo& renderInfo) const {
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->compileGLObjects(renderInfo);
}

void ComputeDrawer::resizeGLObjectBuffers(unsigned int maxSize) {
    for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->resizeGLObjectBuffers(maxSize);
}

void ComputeDrawer::releaseGLObjects(osg::State* state) const {
    for (const std::unique_ptr<SkinSlot>& slot : _slots) slot->releaseGLObjects(state);
}

} // namespace osgSkin
