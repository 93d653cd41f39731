// SPDX-License-Identifier: MIT
#pragma once

#include "model/PieceVertices.h"
#include "points/EllipticCylinder.h"

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Vertices that become one piece of a BoundsProxy.
struct SkinPiece {
    Rows rows;
    EllipticCylinder shape;
    float excess = 0.0f; ///< by how much bounds are larger for its sake in a usual pose
};

/// Cuts a skin into pieces such that those with fixed ratios stand well for their vertices. Where
/// several cuts are worth the same to a few digits, as a symmetrical body's are, the first one is
/// taken: the pieces do not depend on how sums are rounded.
///
/// \param vertices at least one
/// \param extent of the skin
/// \param most pieces
std::vector<SkinPiece> cutSkin(const PieceVertices& vertices, float extent, std::size_t most);

} // namespace osgSkin
