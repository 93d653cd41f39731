// SPDX-License-Identifier: MIT
#include "chains/PosedChains.h"

#include "chains/ChainKernel.h"
#include "model/SkinModelAccess.h"

#include <algorithm>
#include <array>
#include <bitset>

namespace osgSkin {
namespace {

constexpr std::size_t kMostSteps = ChainPlan::kMostStates + ChainPlan::kMostOuts;
using Needed = std::array<bool, kMostSteps>;

/// Tells the steps that some of a section's groups need.
///
/// \return false where all are to be done
bool findNeeded(const SkinModel& model, const ChainPlan& plan, const ChainPlan::Section& section,
                std::size_t firstGroup, std::size_t endGroup, Needed& needed) noexcept {
    const std::size_t count = section.endStep - section.firstStep;
    if (count > needed.size()) return false; // of a group that is too long for that
    std::bitset<ChainPlan::kMaps> maps;
    std::bitset<ChainPlan::kMostOuts> outs;
    for (std::size_t g = firstGroup; g < endGroup; ++g) {
        const ChainPlan::Group& group = plan.groups[g];
        for (std::size_t k = 0; k < model.groups()[g].partialCount; ++k)
            outs.set(plan.links[group.firstLink + k].out);
        if (group.lead != ChainPlan::kNoLead) outs.set(group.lead);
    }
    for (std::size_t i = count; i-- > 0;) {
        const ChainPlan::Step& step = plan.steps[section.firstStep + i];
        needed[i] = step.isOut ? outs[step.to] : maps[step.to];
        if (needed[i]) maps.set(step.from);
    }
    return true;
}

} // namespace

void PosedChains::set(const SkinModel& model, const Pose& pose, const ChainPlan::Section& section,
                      std::size_t firstGroup, std::size_t endGroup) noexcept {
    const SkinBlocks& blocks = SkinModelAccess::blocks(model);
    const ChainPlan& plan = blocks.plan;
    const std::size_t index = static_cast<std::size_t>(&section - plan.sections.data());
    const bool whole = firstGroup <= (index > 0 ? plan.sections[index - 1].endGroup : 0) &&
                       endGroup >= section.endGroup;
    Needed needed;
    const bool some = !whole && findNeeded(model, plan, section, firstGroup, endGroup, needed);
    multiplyOut({pose, plan, section, blocks.smallMove, some ? needed.data() : nullptr}, *this);
}

} // namespace osgSkin
