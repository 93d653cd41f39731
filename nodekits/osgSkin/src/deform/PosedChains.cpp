// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, through foreach_target.h; the best is chosen at run time.
#include "deform/PosedChains.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/PosedChains.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "deform/ChainStates-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// The rotation into a joint's frame (rows v, w x v, w) and back.
HWY_INLINE void poseFrame(const PlannedFrame& of, float cosine, float sine, KernelMap& into,
                          KernelMap& back) {
#if HWY_TARGET == HWY_SCALAR
    into = back = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float frame[3] = {cosine * of.e1[axis] + sine * of.e2[axis],
                                cosine * of.e2[axis] - sine * of.e1[axis], of.w[axis]};
        for (std::size_t i = 0; i < 3; ++i) into.column[axis][i] = back.column[i][axis] = frame[i];
    }
    into.column[3][3] = 1.0f;
#else
    const hn::CappedTag<float, 4> d;
    const auto e1 = hn::Load(d, of.e1), e2 = hn::Load(d, of.e2), w = hn::Load(d, of.w);
    const auto c = hn::Set(d, cosine), s = hn::Set(d, sine), zero = hn::Zero(d);
    const auto v = hn::MulAdd(c, e1, hn::Mul(s, e2)), across = hn::MulSub(c, e2, hn::Mul(s, e1));
    hn::Store(v, d, back.column[0]);
    hn::Store(across, d, back.column[1]);
    hn::Store(w, d, back.column[2]);
    const auto even = hn::InterleaveLower(d, v, w), odd = hn::InterleaveLower(d, across, zero);
    hn::Store(hn::InterleaveLower(d, even, odd), d, into.column[0]);
    hn::Store(hn::InterleaveUpper(d, even, odd), d, into.column[1]);
    hn::Store(
        hn::InterleaveLower(d, hn::InterleaveUpper(d, v, w), hn::InterleaveUpper(d, across, zero)),
        d, into.column[2]);
    hn::Store(hn::Load(d, kNoMove), d, into.column[3]);
#endif
}

/// \param cosine of the joint's azimuth; so is the sine
HWY_INLINE void poseWideInto(const PlannedWideInto& of, double cosine, double sine, PosedMap& to) {
    const JointTag d;
    double* const into = to.column[0]; // of all sixteen
    for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        const auto rest =
            hn::MulAdd(hn::Load(d, of.bySine + i), each(sine), hn::Load(d, of.constant + i));
        hn::Store(hn::MulAdd(hn::Load(d, of.byCosine + i), each(cosine), rest), d, into + i);
    }
}

/// Computes the maps between rest space and the frames of the section's partial joints.
HWY_INLINE void poseFrames(const ChainCall& call, const JointRows& rows, PosedChains& chains) {
    const ChainPlan::Section& next = (&call.section)[1];
    for (std::size_t i = call.section.frame; i < next.frame; ++i) {
        const PlannedFrame& of = call.plan.frames[i];
        poseFrame(of, chains.joints.azimuthCosine[of.joint], chains.joints.azimuthSine[of.joint],
                  chains.maps[ChainPlan::into(of.joint)], chains.maps[ChainPlan::frame(of.joint)]);
    }
    for (std::size_t i = call.section.wideInto; i < next.wideInto; ++i) {
        const PlannedWideInto& of = call.plan.wideIntos[i];
        const auto azimuth = [&](std::size_t row) {
            return PoseAccess::kAzimuthStep * rows.azimuths[row * rows.stride + of.joint];
        };
        poseWideInto(of, azimuth(0), azimuth(1), chains.wide[ChainPlan::into(of.joint)]);
    }
}

template <bool kScaled>
HWY_INLINE void makeMaps(const ChainCall& call, const JointRows& rows, PosedChains& chains) {
    makeStates<kScaled>(call, rows, chains);
    makeOuts<kScaled>(call, chains);
}

HWY_NOINLINE JointRows gather(const ChainCall& call, std::size_t count, GatheredRows& to) {
    constexpr std::size_t kStride = ChainPlan::kMaxJoints;
    static_assert(kStride % kAtOnce == 0);
    const JointRows from = rowsOf(call.pose);
    const std::size_t padded = (count + kAtOnce - 1) / kAtOnce;
    for (std::size_t i = 0; i < padded * kAtOnce; ++i) {
        const std::size_t joint = call.plan.joints[call.section.joint + HWY_MIN(i, count - 1)];
        for (std::size_t row = 0; row < PoseAccess::kNumberRows; ++row)
            to.own[row * kStride + i] = from.own[row * from.stride + joint];
        for (std::size_t row = 0; row < PoseAccess::kRestRows; ++row)
            to.rest[row * kStride + i] = from.rest[row * from.stride + joint];
        for (std::size_t row = 0; row < 2; ++row)
            to.azimuths[row * kStride + i] = from.azimuths[row * from.stride + joint];
        to.parents[i] = from.parents[joint];
    }
    return {to.own, to.rest, to.azimuths, to.parents, kStride};
}

/// Calls `pose` for all joints, one vector of them at a time.
template <typename PoseThem>
HWY_INLINE void forJoints(std::size_t count, const PoseThem& pose) {
    const std::size_t lanes = hn::Lanes(JointTag());
    for (std::size_t next = 0; next < count; next += lanes)
        pose(count >= lanes ? HWY_MIN(next, count - lanes) : next); // the last ones overlap
}

void multiplyOutAll(const ChainCall& call, PosedChains& chains) {
    const JointTag d;
    GatheredRows room;
    const std::size_t count = (&call.section)[1].joint - call.section.joint;
    const JointRows rows =
        call.plan.inOrder && count >= hn::Lanes(d) ? rowsOf(call.pose) : gather(call, count, room);
    const Joints one = each(1.0);
    JointMask adjusted = hn::Lt(one, one), scaled = adjusted;
    forJoints(count, [&](std::size_t first)
                         HWY_ATTR { poseJoints(rows, first, call, chains, adjusted, scaled); });
    chains.scaled = !hn::AllFalse(d, scaled);
    chains.joints.anyAdjusted = !hn::AllFalse(d, adjusted);
    if (HWY_UNLIKELY(chains.joints.anyAdjusted))
        forJoints(count, [&](std::size_t first) HWY_ATTR { poseMoves(rows, first, chains); });
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row) {
            chains.wide[ChainPlan::kIdentity].column[column][row] = column == row ? 1.0 : 0.0;
            chains.maps[ChainPlan::kIdentity].column[column][row] = column == row ? 1.0f : 0.0f;
        }
    poseFrames(call, rows, chains);
    chains.scaled ? makeMaps<true>(call, rows, chains) : makeMaps<false>(call, rows, chains);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(multiplyOutAll);

void multiplyOut(const ChainCall& call, PosedChains& chains) noexcept {
    HWY_DYNAMIC_DISPATCH(multiplyOutAll)(call, chains);
}

namespace {

/// Finds the maps that some of a section's groups need.
///
/// \return false where all are needed
bool findNeeded(const SkinModel& model, const ChainPlan& plan, const ChainPlan::Section& section,
                std::size_t firstGroup, std::size_t endGroup, NeededMaps& needed) noexcept {
    const ChainPlan::Section& next = (&section)[1];
    // A group too long for the bit sets.
    if (next.state - section.state > ChainPlan::kMaxStates) return false;
    for (std::size_t g = firstGroup; g < endGroup; ++g) {
        const ChainPlan::Group& group = plan.groups[g];
        for (std::size_t k = 0; k < model.groups()[g].partialCount; ++k)
            needed.outs.set(plan.links[group.firstLink + k].out);
        if (group.lead != ChainPlan::kNoLead) needed.outs.set(group.lead);
    }
    std::bitset<ChainPlan::kMaps> maps;
    std::bitset<ChainPlan::kWideMaps> wide;
    for (std::size_t i = section.out; i < next.out; ++i)
        if (needed.outs[i - section.out]) maps.set(plan.outs[i].from);
    for (std::size_t i = next.state; i-- > section.state;) {
        const ChainPlan::State& state = plan.states[i];
        const bool isNeeded =
            wide[state.to] || (state.narrowed != ChainPlan::kIdentity && maps[state.narrowed]) ||
            (state.narrowedLead != ChainPlan::kIdentity && maps[state.narrowedLead]);
        needed.states[i - section.state] = isNeeded;
        if (isNeeded) wide.set(state.from);
    }
    return true;
}

} // namespace

void PosedChains::set(const SkinModel& model, const Pose& pose, const ChainPlan::Section& section,
                      std::size_t firstGroup, std::size_t endGroup) noexcept {
    const SkinBlocks& blocks = SkinModelAccess::blocks(model);
    const ChainPlan& plan = blocks.plan;
    const bool whole = firstGroup <= section.group && endGroup >= (&section)[1].group;
    NeededMaps needed;
    const bool some = !whole && findNeeded(model, plan, section, firstGroup, endGroup, needed);
    multiplyOut({pose, plan, section, blocks.smallMove, some ? &needed : nullptr}, *this);
}

} // namespace osgSkin
#endif
