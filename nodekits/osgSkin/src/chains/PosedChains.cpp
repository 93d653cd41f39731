// SPDX-License-Identifier: MIT
#include "chains/PosedChains.h"

#include "chains/ChainKernel.h"
#include "model/SkinModelAccess.h"

#include <bitset>

namespace osgSkin {
namespace {

/// Tells the maps that some of a section's groups need.
///
/// \return false where all are to be made
bool findNeeded(const SkinModel& model, const ChainPlan& plan, const ChainPlan::Section& section,
                std::size_t firstGroup, std::size_t endGroup, NeededMaps& needed) noexcept {
    const ChainPlan::Section& next = (&section)[1];
    // Of a group that is too long for that.
    if (next.state - section.state > ChainPlan::kMostStates) return false;
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
