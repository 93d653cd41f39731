// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFMORPHS_H
#define OSGSKINIMPORT_GLTFMORPHS_H 1

#include "gltf/GltfAccessors.h"
#include "gltf/GltfFile.h"

namespace osgSkin {

/// Adds morph targets to positions and normals with the weights that the file gives them at rest
/// (section 3.7.2.2); targets are not read otherwise, and a notice tells where a clip moves them.
///
/// \param file each of its meshes is shown with one set of weights
/// \param accessors of the file
void applyMorphs(GltfFile& file, GltfAccessors& accessors);

} // namespace osgSkin

#endif
