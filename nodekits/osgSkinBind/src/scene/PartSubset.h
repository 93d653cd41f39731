// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/MeshPart>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The triangles of `part` that `keep` says (one entry per triangle), with the vertices they use,
/// in the part's order. All per-vertex arrays come along; the state set is shared.
MeshPart partSubset(const MeshPart& part, const std::vector<bool>& keep);

/// Puts the part's vertices into another order: place i gets vertex order[i]. Triangles, their
/// order, and how it looks stay.
MeshPart reorderedPart(const MeshPart& part, const std::vector<std::uint32_t>& order);

} // namespace osgSkin
