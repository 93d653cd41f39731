// SPDX-License-Identifier: MIT
#pragma once

#include "correctives/CorrectiveWeights.h"
#include "model/BoundsProxy.h"

#include <cstdint>

namespace osgSkin {

/// Adds to `stray` how far they take them in a pose, for the run's patches `from` on: turns keep
/// that distance, whatever the vertex's ratios.
void addCorrectiveStray(const BoundsProxy& skin, const BoundsProxy::Run& run, std::uint32_t from,
                        std::uint32_t count, CorrectiveWeights& weights, float* stray) noexcept;

} // namespace osgSkin
