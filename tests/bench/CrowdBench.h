// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

namespace bench {

/// One frame of a thousand characters, on so many threads; wall-clock time.
void crowd(benchmark::State& state, unsigned int threads);

} // namespace bench
