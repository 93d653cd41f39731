// SPDX-License-Identifier: MIT
#include "deform/KernelSlopes.h"

#include "model/SkinModelAccess.h"

namespace osgSkin {

void KernelSlopes::take(const KernelJoints& joints, std::size_t count) noexcept {
    const double unit = SkinModelAccess::gradients(_model)->unit;
    for (std::size_t j = 0; j < count; ++j) {
        const double bend = joints.bendOf(j).whole(), twist = joints.twistOf(j).whole();
        _angles[j] = {bend, twist, roundedToFloat(unit * bend), roundedToFloat(unit * twist)};
    }
}

void KernelSlopes::prepare(std::size_t group, std::size_t firstBlock, KernelCall& call) noexcept {
    const GradientBlocks& blocks = *SkinModelAccess::gradients(_model);
    const GradientBlocks::Reach* reach = blocks.reach.data() + blocks.firstReach[group];
    call.gradients = nullptr;
    for (std::size_t k = call.linkCount; k-- > 0;) {
        const KernelLink& link = call.links[k];
        const Angles& angles = _angles[link.joint];
        const bool adjusted = call.isAdjusted(link);
        KernelSlope& slope = _slopes[k];
        slope.tilt = linkTilt(reach[k], angles.bend, angles.twist, adjusted);
        if (!slope.tilt.any()) continue;
        slope.bend = angles.bendSlope;
        slope.twist = angles.twistSlope;
        if (adjusted) slope.step = roundedToFloat(blocks.unit);
        call.lastSlope = k;
        call.gradients = blocks
                             .rows[blocks.firstRow[group] +
                                   firstBlock * GradientBlocks::rowsPerBlock(call.linkCount)]
                             .lane;
    }
    call.slopes = _slopes.data();
    const std::size_t block = SkinModelAccess::blocks(_model).firstBlock[group] + firstBlock;
    call.across = &blocks.across[block];
}

} // namespace osgSkin
