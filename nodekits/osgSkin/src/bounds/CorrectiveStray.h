// SPDX-License-Identifier: MIT
#pragma once

#include "correctives/CorrectiveWeights.h"
#include "model/BoundsProxy.h"

namespace osgSkin {

/// How far correctives take the vertices of pieces in a pose: turns keep that distance, whatever
/// the vertex's ratios.
class CorrectiveStray {
public:
    CorrectiveStray(const BoundsProxy& proxy, const SkinModel& model, const Pose& pose) noexcept
        : _proxy(proxy), _weights(model, pose) {}

    float of(const BoundsProxy::Piece& piece) noexcept;

private:
    const BoundsProxy& _proxy;
    CorrectiveWeights _weights;
};

} // namespace osgSkin
