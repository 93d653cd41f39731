// SPDX-License-Identifier: MIT
#ifndef BENCH_CHARACTERBENCH_H
#define BENCH_CHARACTERBENCH_H

#include "BenchBody.h"

#include <benchmark/benchmark.h>

namespace bench {

/// One frame of a thousand characters on a number of threads; wall-clock time.
void crowd(benchmark::State& state, unsigned int threads);

/// The ways to animate and skin a character.
enum class Player {
    Baked,       ///< a ClipPlayer with a baked clip
    Between,     ///< the same between samples: an interpolating ClipPlayer
    Sampled,     ///< an interpolating ClipPlayer with a clip that was not baked
    Skeleton,    ///< osgAnimation's skeleton and an UpdateDeformableSkin
    OsgAnimation ///< osgAnimation's skeleton and its software rig
};

/// Whole frames of twenty characters, each in its own phase: update traversal, bounds, cull
/// traversal and deformation; nothing is drawn. An iteration is one frame of all characters.
void characters(benchmark::State& state, Player player, Kind kind);

/// DeformJob alone over the same poses, for as many characters.
void deformationAlone(benchmark::State& state, Kind kind);

/// The larger skin that gives the cost per vertex.
enum class Larger {
    FinerMesh,       ///< the same body with each edge split in three, as in a finer mesh
    EveryVertexTwice ///< the same groups with twice the vertices; a group's empty lanes count as
                     ///< set-up
};

/// The fixed cost of updating a skin: fits a line through the times of a skin and a larger one and
/// evaluates it at no vertices. `set-up %` is its share of the smaller skin's update.
void setUpShare(benchmark::State& state, Kind kind, Larger larger);

/// Adds the benchmarks of layers of clips, whose names begin with "layers".
void addLayers();

/// Adds the benchmark of poses that are transferred one at a time, "live".
void addLive();

/// Adds the benchmarks of shapes for limbs, whose names begin with "hits".
void addHits();

} // namespace bench

#endif
