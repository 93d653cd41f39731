// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

namespace osgSkin {

/// What rounding errors are taken as: their products would be denormal numbers, which processors
/// are many times slower with.
inline float roundedToFloat(double x) {
    return static_cast<float>(std::fabs(x) < 1e-15 ? 0.0 : x);
}

/// x -> turn x + move, in single precision, as the kernel reads it: columns of the turn, then the
/// move. Behind that by how much positions are to be scaled before.
struct alignas(64) KernelMap {
    float column[4][4];

    const float& turn(std::size_t row, std::size_t at) const { return column[at][row]; }
    const float& move(std::size_t row) const { return column[3][row]; }
    const float& scale() const { return column[3][3]; }
};

} // namespace osgSkin
