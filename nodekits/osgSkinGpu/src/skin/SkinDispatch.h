// SPDX-License-Identifier: MIT
#pragma once

#include "skin/ContextSupport.h"

#include <osgSkinGpu/GpuModel>

#include <osg/Drawable>
#include <osg/ref_ptr>

#include <array>
#include <atomic>

namespace osgSkin {

/// Computes a skin's vertices when it is drawn, in each context once for each pose that it is
/// given.
class SkinDispatch : public osg::Drawable {
public:
    explicit SkinDispatch(const osg::ref_ptr<const GpuModel>& model);

    /// In no thread's draw: its next draw computes.
    void setPose(unsigned int number) { _pose = number; }

    bool isDone(unsigned int contextId) const { return _done[contextId] == _pose; }

    static unsigned int count();

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;
    void releaseGLObjects(osg::State* state) const override;

private:
    osg::ref_ptr<const GpuModel> _model;
    std::atomic<unsigned int> _pose{0};
    mutable std::array<std::atomic<unsigned int>, kMostContexts> _done{};
};

} // namespace osgSkin
