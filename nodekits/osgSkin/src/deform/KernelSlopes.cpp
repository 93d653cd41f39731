// SPDX-License-Identifier: MIT
#include "deform/KernelSlopes.h"

#include "model/SkinModelAccess.h"

#include <hwy/base.h>

#include <algorithm>

namespace osgSkin {

void KernelSlopes::take(const KernelJoints& joints, std::size_t jointCount,
                        std::size_t endGroup) noexcept {
    const auto unit = static_cast<float>(SkinModelAccess::gradients(_model)->unit);
    for (std::size_t j = 0; j < jointCount; ++j) {
        _bendSlopes[j] = unit * joints.wholeBend[j]; // exact: a power of two
        _twistSlopes[j] = unit * joints.wholeTwist[j];
    }
    const ChainPlan::Group& last = SkinModelAccess::blocks(_model).plan.groups[endGroup - 1];
    _joints = &joints;
    _endOfAll = last.firstLink + _model.groups()[endGroup - 1].partialCount;
    _firstLink = _endLink = 0;
}

/// Groups reach to as many links as GradientBlocks::reach has.
void KernelSlopes::findTilts(std::size_t first) noexcept {
    _firstLink = first;
    _endLink = std::min(first + LinkTilts::kMost, _endOfAll);
    _tilts.find(SkinModelAccess::blocks(_model).plan.links.data() + first,
                SkinModelAccess::gradients(_model)->reach.data() + first, _endLink - first,
                *_joints);
}

void KernelSlopes::prepare(std::size_t group, std::size_t firstBlock, KernelCall& call) noexcept {
    const GradientBlocks& blocks = *SkinModelAccess::gradients(_model);
    const std::size_t first = blocks.firstReach[group]; // reach stands as the plan's links do
    if (first < _firstLink || first + call.linkCount > _endLink) findTilts(first);
    call.bendTilts = LinkTilts::some(_tilts.bends, first - _firstLink, call.linkCount);
    call.twistTilts = LinkTilts::some(_tilts.twists, first - _firstLink, call.linkCount);
    std::uint32_t tilts = call.bendTilts | call.twistTilts;
    if (call.joints->anyAdjusted)
        for (std::size_t k = 0; k < call.linkCount; ++k)
            tilts |= std::uint32_t(call.isAdjusted(call.links[k])) << k;
    call.gradients = nullptr;
    if (tilts == 0) return;
    call.lastSlope = hwy::Num0BitsBelowLS1Bit_Nonzero32(tilts);
    call.bendSlopes = _bendSlopes;
    call.twistSlopes = _twistSlopes;
    call.slopeUnit = static_cast<float>(blocks.unit);
    const std::size_t row =
        blocks.firstRow[group] + firstBlock * GradientBlocks::rowsPerBlock(call.linkCount);
    call.gradients = blocks.rows[row].lane;
    call.across = &blocks.across[SkinModelAccess::blocks(_model).firstBlock[group] + firstBlock];
}

} // namespace osgSkin
