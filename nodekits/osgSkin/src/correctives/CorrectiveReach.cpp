// SPDX-License-Identifier: MIT
#include "CorrectiveReach.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Length of the k-th mode's shares in a lane.
float lengthOf(const CorrectiveRow* block, std::size_t mode, std::size_t lane) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float share = block[3 * mode + axis].lane[lane];
        sum += share * share;
    }
    return std::sqrt(sum);
}

} // namespace

void addCorrectiveReach(const CorrectiveBlocks& blocks,
                        const std::vector<std::vector<std::uint32_t>>& patches, BoundSkin& skin) {
    const std::size_t group = skin.runs.size() - 1; // a run a group
    BoundSkin::Run& run = skin.runs.back();
    run.firstCorrection = static_cast<std::uint32_t>(skin.corrections.size());
    for (std::uint32_t i = blocks.firstRange[group]; i < blocks.firstRange[group + 1]; ++i) {
        const CorrectiveBlocks::Range& range = blocks.ranges[i];
        const std::size_t modes = blocks.joints[range.joint].modes;
        const std::size_t first = skin.reach.size();
        skin.corrections.push_back({range.joint, first});
        skin.reach.resize(first + modes * patches.size(), 0.0f);
        for (std::size_t patch = 0; patch < patches.size(); ++patch)
            for (const std::uint32_t row : patches[patch])
                if (const CorrectiveRow* block = blocks.blockOf(range, row))
                    for (std::size_t k = 0; k < modes; ++k) {
                        float& reach = skin.reach[first + k * patches.size() + patch];
                        reach = std::max(reach, lengthOf(block, k, row % kBlock));
                    }
    }
    run.correctionCount = static_cast<std::uint32_t>(skin.corrections.size()) - run.firstCorrection;
}

void addCorrectiveStray(const BoundSkin& skin, const BoundSkin::Run& run, std::uint32_t from,
                        std::uint32_t count, CorrectiveWeights& weights, float* stray) noexcept {
    for (std::uint32_t i = run.firstCorrection; i < run.firstCorrection + run.correctionCount;
         ++i) {
        const BoundSkin::Correction& correction = skin.corrections[i];
        const CorrectiveWeights::Weights* now = weights.of(correction.joint);
        if (!now) continue;
        const float* reach = skin.reach.data() + correction.firstReach + from;
        for (std::size_t k = 0; k < weights.modesOf(correction.joint);
             ++k, reach += run.patchCount) {
            const float weight = std::abs(now->positions[k]);
            for (std::uint32_t p = 0; p < count; ++p) stray[p] += weight * reach[p];
        }
    }
}

} // namespace osgSkin
