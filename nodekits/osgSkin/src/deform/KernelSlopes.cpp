// SPDX-License-Identifier: MIT
#include "deform/KernelSlopes.h"

#include "model/SkinModelAccess.h"

namespace osgSkin {

KernelSlopes::KernelSlopes(const SkinModel& model) noexcept
    : _model(model), _blocks(SkinModelAccess::gradients(model)) {}

void KernelSlopes::take(const KernelJoints& joints, std::size_t jointCount,
                        KernelRun& run) noexcept {
    const auto unit = static_cast<float>(_blocks->unit);
    for (std::size_t j = 0; j < jointCount; ++j) {
        _bendSlopes[j] = unit * joints.wholeBend[j]; // exact: a power of two
        _twistSlopes[j] = unit * joints.wholeTwist[j];
    }
    run.bendSlopes = _bendSlopes;
    run.twistSlopes = _twistSlopes;
    run.slopeUnit = unit;
    _joints = &joints;
}

std::size_t KernelSlopes::find(std::size_t firstGroup, std::size_t endGroup,
                               KernelRun& run) noexcept {
    const SkinBlocks& blocks = SkinModelAccess::blocks(_model);
    const auto endOf = [&](std::size_t g) {
        return std::size_t(blocks.groups[g].firstLink) + blocks.groups[g].linkCount;
    };
    const std::size_t first = blocks.groups[firstGroup].firstLink;
    while (endOf(endGroup - 1) > first + LinkTilts::kMost) --endGroup;
    // Reach stands as the plan's links do.
    _tilts.find(blocks.plan.links.data() + first, _blocks->reach.data() + first,
                endOf(endGroup - 1) - first, *_joints);
    run.tilts = &_tilts;
    run.firstTilt = first;
    return endGroup;
}

} // namespace osgSkin
