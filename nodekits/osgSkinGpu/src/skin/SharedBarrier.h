// SPDX-License-Identifier: MIT
#pragma once

#include "skin/ContextSupport.h"

#include <osg/Drawable>
#include <osg/StateSet>
#include <osg/ref_ptr>
#include <osgUtil/CullVisitor>

#include <array>
#include <atomic>

namespace osgSkin {

/// What makes the draws of a frame wait for all skins that were computed before them: one leaf
/// for all skins, which does nothing in a context where nothing has been computed since.
class SharedBarrier : public osg::Drawable {
public:
    static SharedBarrier& instance();

    SharedBarrier();

    /// Puts it behind the dispatches of a cull's render stage and before all else; any thread.
    void addTo(osgUtil::CullVisitor& cv);

    /// Called in the context's draw: it has computed something.
    void need(unsigned int contextId) { _needed[contextId] = true; }

    unsigned int count() const { return _count; }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<osg::StateSet> _place;
    mutable std::array<std::atomic<bool>, kMostContexts> _needed{};
    mutable std::atomic<unsigned int> _count{0};
};

/// The render bins of what is computed before a stage's draws, and of what makes these wait.
enum ComputeBin { kComputeBin = -1000, kBarrierBin };

/// Lets what has a state be drawn in one of them, whatever a state above it says of bins.
void setUpBin(osg::StateSet& state, ComputeBin bin);

/// Puts a drawable, which no camera moves, into a cull's render stage by its own state alone.
void addToStage(osgUtil::CullVisitor& cv, osg::Drawable& drawable, osg::StateSet& state);

} // namespace osgSkin
