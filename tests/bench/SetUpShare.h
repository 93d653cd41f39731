// SPDX-License-Identifier: MIT
#pragma once

#include "BenchBody.h"

#include <benchmark/benchmark.h>

namespace bench {

/// The larger skin that tells what a vertex costs.
enum class Larger {
    FinerMesh,       ///< the same body with three edges for each: what users have who have more
    EveryVertexTwice ///< the same groups, twice as full: a group's empty lanes count as set-up, too
};

/// What an update of a skin costs beside its vertices: the line through the times of a skin and of
/// a larger one, at no vertices; `set-up %` is its share of the smaller one's update.
void setUpShare(benchmark::State& state, Kind kind, Larger larger);

} // namespace bench
