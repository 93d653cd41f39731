// SPDX-License-Identifier: MIT
#pragma once

#include "../BoundSkin.h"
#include "CorrectiveWeights.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Adds to the last run of `skin` how far correctives can take the vertices of its patches.
/// \param patches rows of the run's group
void addCorrectiveReach(const CorrectiveBlocks& blocks,
                        const std::vector<std::vector<std::uint32_t>>& patches, BoundSkin& skin);

/// Adds to `stray` how far they take them in a pose, for the run's patches `from` on: turns keep
/// that distance, whatever the vertex's ratios.
void addCorrectiveStray(const BoundSkin& skin, const BoundSkin::Run& run, std::uint32_t from,
                        std::uint32_t count, CorrectiveWeights& weights, float* stray) noexcept;

} // namespace osgSkin
