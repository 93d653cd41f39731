// SPDX-License-Identifier: MIT
#include "bounds/CorrectiveStray.h"

#include <cmath>

namespace osgSkin {

float CorrectiveStray::of(const BoundsProxy::Piece& piece) noexcept {
    float stray = 0.0f;
    const BoundsProxy::Correction* next = _proxy.corrections.data() + piece.firstCorrection;
    for (const auto* end = next + piece.correctionCount; next != end; ++next) {
        const CorrectiveWeights::Weights* now = _weights.of(next->joint);
        if (!now) continue;
        const float* reach = _proxy.reach.data() + next->firstReach;
        for (std::size_t k = 0; k < _weights.modesOf(next->joint); ++k)
            stray += std::abs(now->positions[k]) * reach[k];
    }
    return stray;
}

} // namespace osgSkin
