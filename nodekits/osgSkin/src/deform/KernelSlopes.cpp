// SPDX-License-Identifier: MIT
#include "deform/KernelSlopes.h"

#include "model/SkinModelAccess.h"

#include <hwy/base.h>

#include <algorithm>

namespace osgSkin {

KernelSlopes::KernelSlopes(const SkinModel& model) noexcept
    : _model(model), _links(SkinModelAccess::blocks(model).plan.links.data()),
      _blocks(SkinModelAccess::gradients(model)) {}

void KernelSlopes::take(const KernelJoints& joints, std::size_t jointCount, std::size_t endGroup,
                        KernelCall& call) noexcept {
    const auto unit = static_cast<float>(_blocks->unit);
    for (std::size_t j = 0; j < jointCount; ++j) {
        _bendSlopes[j] = unit * joints.wholeBend[j]; // exact: a power of two
        _twistSlopes[j] = unit * joints.wholeTwist[j];
    }
    call.bendSlopes = _bendSlopes;
    call.twistSlopes = _twistSlopes;
    call.slopeUnit = unit;
    _joints = &joints;
    _endOfAll = _blocks->firstReach[endGroup - 1] + _model.groups()[endGroup - 1].partialCount;
    _firstLink = _endLink = 0;
}

void KernelSlopes::findTilts(std::size_t first) noexcept {
    _firstLink = first;
    _endLink = std::min(first + LinkTilts::kMost, _endOfAll);
    _tilts.find(_links + first, _blocks->reach.data() + first, _endLink - first, *_joints);
}

void KernelSlopes::prepare(std::size_t group, std::size_t firstBlock, std::size_t block,
                           KernelCall& call) noexcept {
    const std::size_t first = _blocks->firstReach[group]; // reach stands as the plan's links do
    if (first < _firstLink || first + call.linkCount > _endLink) findTilts(first);
    call.bendTilts = LinkTilts::some(_tilts.bends, first - _firstLink, call.linkCount);
    call.twistTilts = LinkTilts::some(_tilts.twists, first - _firstLink, call.linkCount);
    std::uint32_t tilts = call.bendTilts | call.twistTilts;
    if (_joints->anyAdjusted)
        for (std::size_t k = 0; k < call.linkCount; ++k)
            tilts |= std::uint32_t(call.isAdjusted(call.links[k])) << k;
    call.gradients = nullptr;
    if (tilts == 0) return;
    call.lastSlope = hwy::Num0BitsBelowLS1Bit_Nonzero32(tilts);
    const std::size_t row =
        _blocks->firstRow[group] + firstBlock * GradientBlocks::rowsPerBlock(call.linkCount);
    call.gradients = _blocks->rows.data()[row].lane;
    call.across = _blocks->across.data() + block;
}

} // namespace osgSkin
