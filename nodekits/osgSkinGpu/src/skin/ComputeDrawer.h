// SPDX-License-Identifier: MIT
#pragma once

#include "skin/SkinSlot.h"

#include <osgSkin/DeformableSkin>

#include <memory>
#include <mutex>
#include <vector>

namespace osgSkin {

/// Draws a skin from what compute shaders make of it, see setGpu().
///
/// Two slots are used in turn: a draw thread may still read what the frame before has handed to it
/// while the next one is written.
class ComputeDrawer : public DeformableSkin::Drawer {
public:
    osg::ref_ptr<Drawer> clone() const override { return new ComputeDrawer; }
    void skinChanged(const DeformableSkin& skin) override;
    void poseChanged(const DeformableSkin& skin) override;
    osg::Geometry* cull(const DeformableSkin& skin, osgUtil::CullVisitor& cv) override;
    void compileGLObjects(osg::RenderInfo& renderInfo) const override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    SkinSlot& current(const DeformableSkin& skin);

    mutable std::mutex _mutex;
    osg::ref_ptr<const GpuModel> _model;
    std::vector<std::unique_ptr<SkinSlot>> _slots;
    std::size_t _current = 0;
    unsigned int _pose = 0; ///< counts those that were handed to a slot
    bool _isDirty = true, _isHandedOut = false;
};

} // namespace osgSkin
