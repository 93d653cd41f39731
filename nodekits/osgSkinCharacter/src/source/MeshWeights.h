// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinBind/BindWeights>
#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/RestSkeleton>

#include <string>

namespace osgSkin {

/// The weights that a mesh file carries itself, vertex by vertex.
///
/// \param file the mesh's, for complaints
/// \throw Error where the mesh carries none, or names a bone that the skeleton does not have
VertexWeights meshWeights(const std::string& file, const ImportedMesh& body,
                          const RestSkeleton& skeleton);

} // namespace osgSkin
