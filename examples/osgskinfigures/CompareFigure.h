// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

#include <vector>

namespace figures {

class Body;

/// One pose of a joint by each method.
struct Comparison {
    const char* name;
    std::vector<Tile> tiles; ///< linear blending, dual quaternions, ours
};
/// Shoulder, elbow, wrist, hip and knee.
std::vector<Comparison> comparisons(const Body& body, bool painted);

} // namespace figures
