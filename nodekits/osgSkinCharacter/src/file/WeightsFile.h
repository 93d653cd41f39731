// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinBind/BindWeights>
#include <osgSkinRig/RestSkeleton>

#include <cstddef>
#include <string>

namespace osgSkin {

/// Reads painted weights: JSON, {"weights": {"joint": [[vertex, weight], ...], ...}}, with vertices
/// counted from 0 in the mesh file's order. Other members are passed over (makers write notes).
///
/// \param vertices number of the mesh's vertices
/// \throw Error with file, JSON place and what was expected, also where a joint or a vertex is not
///        there
VertexWeights readWeights(const std::string& file, const RestSkeleton& skeleton,
                          std::size_t vertices);

} // namespace osgSkin
