// SPDX-License-Identifier: MIT
#ifndef BENCH_LOADBENCH_H
#define BENCH_LOADBENCH_H

namespace bench {

/// Adds the group "load": a saved character's loading, and the memory of a thousand.
void addLoads();

/// Adds the group "frame of loaded": whole frames of characters as users load them. `update x` and
/// `cull x` are ratios to the deformation of the same frames.
void addLoadedFrames();

/// Adds the group "walkers": a pedestrian's loading, the memory of a thousand, and whole frames of
/// pedestrians and throwers whom a camera at street level sees, below a CharacterGroup and below
/// any group.
void addWalkers();

} // namespace bench

#endif
