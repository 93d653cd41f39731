// SPDX-License-Identifier: MIT
#pragma once

#include "model/BoundsProxy.h"

#include <osgSkin/Pose>

#include <array>

namespace osgSkin {

/// How much the modes of a skin's correctives weigh in a pose: what BoundsProxy::Reach is to be
/// multiplied by, for how far they take vertices. Turns keep that distance, whatever the vertex's
/// ratios.
class CorrectiveStray {
public:
    /// \pre the model has correctives
    CorrectiveStray(const SkinModel& model, const Pose& pose) noexcept;

    /// By BoundsProxy::weightOf(); set of the modes that there are.
    const float* weights() const { return _weights.data(); }

private:
    std::array<float, BoundsProxy::kMostWeights> _weights;
};

} // namespace osgSkin
