// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/MeshPart>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The triangles of `part` that `keep` says (one entry per triangle), with the vertices they use,
/// in the part's order. All per-vertex arrays come along; the state set is shared.
MeshPart partSubset(const MeshPart& part, const std::vector<bool>& keep);

/// Puts the part's vertices into another order: position i gets vertex order[i]. Triangles, their
/// order and the state set stay.
MeshPart reorderedPart(const MeshPart& part, const std::vector<std::uint32_t>& order);

} // namespace osgSkin
