// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Drawable>
#include <osg/Program>
#include <osg/StateSet>
#include <osg/observer_ptr>
#include <osg/ref_ptr>
#include <osgUtil/CullVisitor>

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>

namespace osg {
class State;
} // namespace osg

namespace osgSkin {

/// The most contexts in which skins are computed; in others the processor deforms.
constexpr unsigned int kMaxContexts = 64;

/// A program that its users share. It goes with the last of them: one that outlived its context
/// would be taken for a program of a later context of the same number.
class SharedProgram {
public:
    using Make = osg::ref_ptr<osg::Program> (*)();
    explicit SharedProgram(Make make) : _make(make) {}

    /// The program, made now if nobody has it; thread-safe.
    osg::ref_ptr<osg::Program> get();

private:
    Make _make;
    std::mutex _mutex;
    osg::observer_ptr<osg::Program> _program;
};

/// Whether a context can run the compute shaders; thread-safe. False before the context's first
/// draw, which finds its extensions.
bool canCompute(const osg::State& state);

/// Notes, while the context is current, that it cannot, whatever it reports.
void noteCannotCompute(unsigned int contextId);

/// Whether shaders of the current context can read a buffer of so many texels.
bool canReadTexels(unsigned int contextId, std::size_t texels);

/// Makes the draws of a frame wait for the skins that were computed before: one leaf for all skins,
/// which does nothing where nothing has been computed.
class SharedBarrier : public osg::Drawable {
public:
    static SharedBarrier& instance();

    SharedBarrier();

    /// Adds it to a cull's render stage, after the dispatches and before all else; thread-safe.
    void addTo(osgUtil::CullVisitor& cv);

    /// To be called in a context's draw after a dispatch.
    void need(unsigned int contextId) { _needed[contextId] = true; }

    unsigned int count() const { return _count; }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<osg::StateSet> _place;
    mutable std::array<std::atomic<bool>, kMaxContexts> _needed{};
    mutable std::atomic<unsigned int> _count{0};
};

/// The render bins of uploads, dispatches and the barrier, before all other bins of a stage.
enum ComputeBin { kUploadBin = -1001, kComputeBin, kBarrierBin };

/// Puts a state's drawables into one of these bins, whatever the states above set.
void setUpBin(osg::StateSet& state, ComputeBin bin);

/// Adds a drawable with a state to a cull's render stage.
void addToStage(osgUtil::CullVisitor& cv, osg::Drawable& drawable, osg::StateSet& state);

} // namespace osgSkin
