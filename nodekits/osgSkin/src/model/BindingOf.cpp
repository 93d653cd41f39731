// SPDX-License-Identifier: MIT
#include "model/BindingOf.h"

#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace osgSkin {

Binding bindingOf(const SkinModel& model) {
    // By vertex first: groups have their own order of vertices, and of joints (productOrder()).
    std::vector<std::vector<std::pair<Influence, RatioGradient>>> influences(model.vertexCount());
    const std::vector<RatioGradient> grouped = gradientsOf(model);
    auto gradient = grouped.begin();
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Ratio* ratio = model.ratios().data() + group.firstRatio;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            auto& list = influences[model.order()[group.firstVertex + i]];
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                const SkinModel::Ratio own = link.partial ? *ratio++ : SkinModel::Ratio{1.0f, 1.0f};
                const RatioGradient slope = grouped.empty() ? RatioGradient{} : *gradient++;
                if (own.bend == 0.0f && own.twist == 0.0f) continue; // an influence of others
                list.push_back({{link.joint, own.bend, own.twist}, slope});
            }
            std::sort(list.begin(), list.end(),
                      [](const auto& a, const auto& b) { return a.first.joint < b.first.joint; });
        }
    }
    Binding binding;
    binding.joints = model.joints();
    binding.firstInfluence.push_back(0);
    for (const auto& list : influences) {
        std::uint32_t region = 0;
        for (const auto& [influence, slope] : list) {
            if (influence.bend >= 0.5f) region = influence.joint;
            binding.influences.push_back(influence);
            if (!grouped.empty()) binding.gradients.push_back(slope);
        }
        binding.regions.push_back(region);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    binding.correctives = correctivesOf(model);
    return binding;
}

} // namespace osgSkin
