// SPDX-License-Identifier: MIT
#pragma once

#include "skin/SkinDispatch.h"

#include <osgSkin/DeformableSkin>

#include <osg/Array>
#include <osg/Geometry>
#include <osg/StateSet>
#include <osg/ref_ptr>

namespace osgSkin {

/// All that one pose of a skin is computed and drawn with.
class SkinSlot {
public:
    /// \pre the skin has the model
    SkinSlot(const DeformableSkin& skin, const osg::ref_ptr<const GpuModel>& model);

    /// Writes the pose that the next draw computes.
    void setPose(const GpuModel& model, const Pose& pose, unsigned int number);

    osg::Geometry& geometry() const { return *_geometry; }
    SkinDispatch& dispatch() const { return *_dispatch; }
    osg::StateSet& dispatchState() const { return *_state; }

    void compileGLObjects(osg::RenderInfo& renderInfo) const;
    void resizeGLObjectBuffers(unsigned int maxSize);
    void releaseGLObjects(osg::State* state) const;

private:
    void addOutput(unsigned int index, osg::Array& array);
    void addInput(unsigned int unit, const char* name, osg::TextureBuffer* texture);

    osg::ref_ptr<osg::Geometry> _geometry;
    osg::ref_ptr<osg::Vec4Array> _palette;
    osg::ref_ptr<SkinDispatch> _dispatch;
    osg::ref_ptr<osg::StateSet> _state;
};

} // namespace osgSkin
