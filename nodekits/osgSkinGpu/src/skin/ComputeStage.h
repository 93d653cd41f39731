// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Drawable>
#include <osg/StateSet>
#include <osg/ref_ptr>
#include <osgUtil/CullVisitor>

#include <array>
#include <atomic>
#include <cstddef>

namespace osg {
class State;
} // namespace osg

namespace osgSkin {

/// Contexts that skins are computed in; what others draw is deformed by the processor.
constexpr unsigned int kMostContexts = 64;

/// Whether a context can run our compute shaders. From any thread; false before the context has
/// looked at its own extensions, which it does at its first draw.
bool canCompute(const osg::State& state);

/// Notes that a context cannot, whatever it says of itself.
void noteCannotCompute(unsigned int contextId);

/// Whether a buffer of so many texels can be read by the shaders of a context, the current one.
bool canReadTexels(unsigned int contextId, std::size_t texels);

} // namespace osgSkin

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
