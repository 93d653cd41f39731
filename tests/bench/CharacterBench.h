// SPDX-License-Identifier: MIT
#pragma once

#include "BenchBody.h"

#include <benchmark/benchmark.h>

namespace bench {

/// Who animates and skins a character.
enum class Player {
    Baked,       ///< a ClipPlayer, from a clip that was baked
    Between,     ///< the same between its samples: a ClipPlayer that interpolates
    Sampled,     ///< a ClipPlayer that interpolates, from a clip that was not baked
    Skeleton,    ///< osgAnimation's skeleton and an UpdateDeformableSkin
    OsgAnimation ///< osgAnimation's skeleton and its software rig
};

/// Whole frames of twenty characters, each in its own phase: update traversal, bounds, cull
/// traversal and deformation; nothing is drawn. An iteration is one frame of all of them.
void characters(benchmark::State& state, Player player, Kind kind);

/// DeformJob alone over the same poses, of as many characters.
void deformationAlone(benchmark::State& state, Kind kind);

} // namespace bench
