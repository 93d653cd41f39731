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
        const double bend = link.bend.whole(), twist = link.twist.whole();
        KernelSlope& slope = _slopes[k];
        slope.tilt = linkTilt(reach[k], bend, twist, link.adjusted);
        if (!slope.tilt.any()) continue;
        slope.bend = blocks.unit * bend;
        slope.twist = blocks.unit * twist;
        if (link.adjusted) slope.step = blocks.unit;
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
