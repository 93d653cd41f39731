// SPDX-License-Identifier: MIT
#include "bounds/CorrectiveStray.h"

#include "correctives/CorrectiveWeights.h"

#include <cmath>

namespace osgSkin {

CorrectiveStray::CorrectiveStray(const SkinModel& model, const Pose& pose) noexcept {
    CorrectiveWeights weights(model, pose);
    const std::size_t joints = SkinModelAccess::correctives(model)->joints.size();
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        const CorrectiveWeights::Weights* now = weights.of(joint);
        float* const to = &_weights[BoundsProxy::weightOf(joint, 0)];
        for (std::size_t k = 0; k < weights.modesOf(joint); ++k)
            to[k] = now ? std::abs(now->positions[k]) : 0.0f;
    }
}

} // namespace osgSkin
