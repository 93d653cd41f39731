// SPDX-License-Identifier: MIT
#ifndef BENCH_CHARACTERBENCH_H
#define BENCH_CHARACTERBENCH_H

#include "BenchBody.h"

#include <benchmark/benchmark.h>

namespace bench {

/// One frame of a thousand characters, on so many threads; wall-clock time.
void crowd(benchmark::State& state, unsigned int threads);

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

/// The larger skin that tells what a vertex costs.
enum class Larger {
    FinerMesh,       ///< the same body with three edges for each: what users have who have more
    EveryVertexTwice ///< the same groups, twice as full: a group's empty lanes count as set-up, too
};

/// What an update of a skin costs beside its vertices: the line through the times of a skin and of
/// a larger one, at no vertices; `set-up %` is its share of the smaller one's update.
void setUpShare(benchmark::State& state, Kind kind, Larger larger);

} // namespace bench

#endif
