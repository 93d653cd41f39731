// SPDX-License-Identifier: MIT
#include "correctives/CorrectiveStray.h"

#include <cmath>

namespace osgSkin {

void addCorrectiveStray(const BoundsProxy& skin, const BoundsProxy::Run& run, std::uint32_t from,
                        std::uint32_t count, CorrectiveWeights& weights, float* stray) noexcept {
    for (std::uint32_t i = run.firstCorrection; i < run.firstCorrection + run.correctionCount;
         ++i) {
        const BoundsProxy::Correction& correction = skin.corrections[i];
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
