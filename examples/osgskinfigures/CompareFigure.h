// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

#include <vector>

namespace figures {

class Body;

/// One pose of a joint by each method.
struct Comparison {
    const char* name;
    /// Linear blending, dual quaternions, the paper's model where the body has shapes, ours, and
    /// the elastic body.
    std::vector<Tile> tiles;
};
/// Shoulder, elbow, wrist, hip and knee.
/// \param painted whether the peers' weights are
/// \param elastic the same body with elastic shapes; may be null
std::vector<Comparison> comparisons(const Body& body, bool painted, const Body* elastic);

} // namespace figures
