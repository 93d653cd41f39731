// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bench {

/// A vertex as a mean of up to three old ones (a corner of an old triangle, a point on an edge or
/// inside it). Unused corners have share 0.
struct Blend {
    std::array<std::uint32_t, 3> corner{};
    std::array<double, 3> share{};
};

struct Subdivided {
    std::vector<Blend> vertices;          ///< old vertices first, in their order
    std::vector<std::uint32_t> triangles; ///< three vertex indices each
};

/// Splits every edge into `parts` and every triangle into parts^2 flat ones: about parts^2 times
/// as many vertices. Shared edges stay shared.
Subdivided subdivide(const std::vector<std::uint32_t>& triangles, std::size_t vertices,
                     std::uint32_t parts);

} // namespace bench
