// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

namespace quality {

/// Angles between the normals that a method gives and those of the posed skin itself, degrees.
struct NormalError {
    double mean = 0.0, percentile95 = 0.0;
};

/// Over the vertices that the skin's triangles use.
NormalError normalError(const Subject& subject, const PosedSkin& posed);

/// Over those of `vertices` that the skin's triangles use.
NormalError normalError(const Subject& subject, const PosedSkin& posed,
                        const std::vector<std::uint32_t>& vertices);

} // namespace quality
