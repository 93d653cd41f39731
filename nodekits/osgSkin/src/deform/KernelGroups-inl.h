// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELGROUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELGROUPS_INL_H
#undef OSGSKIN_KERNELGROUPS_INL_H
#else
#define OSGSKIN_KERNELGROUPS_INL_H
#endif

#include <hwy/highway.h>

#include "deform/DeformKernel.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// Sets what the groups of a run have in common.
HWY_INLINE void startRun(const KernelRun& run, KernelCall& call) {
    call.joints = run.joints;
    call.outs = run.outs;
    call.weights = run.weights;
    call.correctionCount = 0;
    call.corrections = nullptr;
    call.shareFrame = call.normalShareFrame = nullptr;
    call.firstBlock = run.skippedBlocks;
    call.gradients = nullptr;
    call.bendSlopes = run.bendSlopes;
    call.twistSlopes = run.twistSlopes;
    call.slopeUnit = run.slopeUnit;
}

/// Tells which of a group's blocks are to be corrected.
HWY_INLINE void startCorrections(const KernelRun& run, std::size_t number,
                                 const SkinBlocks::Group& group, KernelCall& call) {
    const CorrectiveBlocks& of = *run.corrections;
    const std::uint32_t* const range = of.firstRange.data() + number;
    call.corrections = of.corrected.data() + range[0];
    const std::size_t count = range[1] - range[0];
    call.correctionCount = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (run.weights[call.corrections[i].joint]) call.correctionCount = count;
    call.shareFrame = of.shareFrames[number];
    call.normalShareFrame =
        group.frame == SkinBlocks::kRestFrame ? nullptr : of.frames.data() + group.frame;
}

/// Sets what a group of a run has of its own, but for its gradients.
HWY_INLINE void startGroup(const KernelRun& run, std::size_t i, KernelCall& call) {
    const SkinBlocks::Group& group = run.groups[i];
    call.linkCount = group.linkCount;
    call.links = run.blocks->plan.links.data() + group.firstLink;
    call.lead = group.lead == ChainPlan::kNoLead ? nullptr : run.outs + group.lead;
    call.rows = run.blocks->rows.data() + group.firstRow;
    call.vertexCount = group.vertexCount;
    call.room = run.endVertex - group.firstVertex;
    call.scatter = run.scatter ? run.scatter + group.firstVertex : nullptr;
    const std::size_t vertex = run.scatter ? 0 : group.firstVertex;
    call.positions = run.positions + 3 * vertex;
    call.normals = run.normals ? run.normals + 3 * vertex : nullptr;
    call.tangents = run.tangents ? run.tangents + 4 * vertex : nullptr;
    call.tangentRows =
        run.tangents ? run.tangentRows + group.firstBlock * SkinBlocks::kTangentRows : nullptr;
    if (run.corrections) startCorrections(run, run.firstGroup + i, group, call);
}

/// Sets a group's gradients, and which of its links tilt normals in this pose.
///
/// \return false where none does: they turn as their vertices do then
HWY_INLINE bool startSlopes(const KernelRun& run, std::size_t i, KernelCall& call) {
    const SkinBlocks::Group& group = run.groups[i];
    const std::size_t first = group.firstLink - run.firstTilt;
    call.bendTilts = LinkTilts::some(run.tilts->bends, first, call.linkCount);
    call.twistTilts = LinkTilts::some(run.tilts->twists, first, call.linkCount);
    std::uint32_t tilts = call.bendTilts | call.twistTilts;
    if (HWY_UNLIKELY(run.joints->anyAdjusted))
        for (std::size_t k = 0; k < call.linkCount; ++k)
            tilts |= std::uint32_t(call.isAdjusted(call.links[k])) << k;
    if (tilts == 0) return false;
    call.lastSlope = hwy::Num0BitsBelowLS1Bit_Nonzero32(tilts);
    const GradientBlocks& of = *run.gradients;
    const std::size_t row = of.firstRow[run.firstGroup + i] +
                            run.skippedBlocks * GradientBlocks::rowsPerBlock(call.linkCount);
    call.gradients = of.rows[row].lane;
    call.across = of.across.data() + group.firstBlock;
    return true;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
