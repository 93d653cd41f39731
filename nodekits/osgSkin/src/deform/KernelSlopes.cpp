// SPDX-License-Identifier: MIT
#include "deform/KernelSlopes.h"

#include "model/SkinModelAccess.h"

namespace osgSkin {

void KernelSlopes::prepare(std::size_t group, std::size_t firstBlock, KernelCall& call) noexcept {
    const GradientBlocks& blocks = *SkinModelAccess::gradients(_model);
    const GradientBlocks::Reach* reach = blocks.reach.data() + blocks.firstReach[group];
    call.gradients = nullptr;
    for (std::size_t k = call.linkCount; k-- > 0;) {
        const KernelLink& link = call.links[k];
        const double bend = call.joints->bendOf(link.joint).whole();
        const double twist = call.joints->twistOf(link.joint).whole();
        const bool adjusted = call.isAdjusted(link);
        KernelSlope& slope = _slopes[k];
        slope.tilt = linkTilt(reach[k], bend, twist, adjusted);
        if (!slope.tilt.any()) continue;
        slope.bend = roundedToFloat(blocks.unit * bend);
        slope.twist = roundedToFloat(blocks.unit * twist);
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
