// SPDX-License-Identifier: MIT
#include "ratios/PackInfluences.h"

#include <osgSkin/SkinModel>

#include <algorithm>
#include <functional>

namespace osgSkin {
namespace {

/// Ratios this close to 0 or 1 cost time in every frame for an invisible movement.
constexpr double kNothing = 1e-4;

float ratio(double a) {
    if (a < kNothing) return 0.0f;
    return a > 1.0 - kNothing ? 1.0f : static_cast<float>(a);
}

float distanceToFull(float a) {
    return std::min(a, 1.0f - a);
}

/// The distance of a joint's ratios from 0 or 1.
float partialness(const Influence& i) {
    return std::max(distanceToFull(i.bend), distanceToFull(i.twist));
}

/// partialness() of the first surplus joint; 0 if there is none.
/// \param counts whether an influence counts
template <typename Counts>
float excess(const std::vector<Influence>& all, std::size_t mostPartial, const Counts& counts) {
    std::vector<float> partial;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].isFractional() && counts(i)) partial.push_back(partialness(all[i]));
    if (partial.size() <= mostPartial) return 0.0f;
    const auto extra = partial.begin() + static_cast<std::ptrdiff_t>(mostPartial);
    std::nth_element(partial.begin(), extra, partial.end(), std::greater<>());
    return *extra;
}

/// Stretches [margin, 1 - margin] to [0, 1] and clamps.
float stretched(float a, float margin) {
    if (margin >= 0.499f) return a < 0.5f ? 0.0f : 1.0f;
    return std::clamp((a - margin) / (1.0f - 2.0f * margin), 0.0f, 1.0f);
}

} // namespace

bool packInfluences(const std::vector<JointRatio>& ratios, std::size_t mostPartial,
                    std::vector<Influence>& influences) {
    std::vector<Influence> all;
    all.reserve(ratios.size());
    for (const JointRatio& of : ratios) all.push_back({of.joint, ratio(of.bend), ratio(of.twist)});

    const auto counts = [&all](std::size_t i) {
        return i + 1 == all.size() || all[i].bend != all[i + 1].bend ||
               all[i].twist == all[i + 1].twist;
    };
    const float margin =
        std::max(excess(all, mostPartial, counts),
                 excess(all, SkinModel::kMaxPartialInfluences, [](std::size_t) { return true; }));
    if (margin > 0.0f)
        for (Influence& influence : all) {
            // ratio() rounds those that differ from the surplus one only by rounding errors.
            influence.bend = ratio(stretched(influence.bend, margin));
            influence.twist = ratio(stretched(influence.twist, margin));
        }
    // A joint that only twists skin is partial, too. If there are more than the runtime can split,
    // the lowest ones get their bend ratio as twist ratio.
    auto partial = std::count_if(all.begin(), all.end(),
                                 [](const Influence& influence) { return influence.isPartial(); });
    for (auto lowest = all.rbegin(); lowest != all.rend(); ++lowest) {
        if (partial <= static_cast<std::ptrdiff_t>(SkinModel::kMaxPartialInfluences)) break;
        if (lowest->isFractional() || !lowest->isPartial()) continue;
        lowest->twist = lowest->bend;
        --partial;
    }
    for (const Influence& influence : all)
        if (influence.bend > 0.0f || influence.twist > 0.0f) influences.push_back(influence);
    return margin > 0.0f;
}

} // namespace osgSkin
