// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFNAMES_H
#define OSGSKINIMPORT_GLTFNAMES_H 1

#include "gltf/GltfFile.h"

namespace osgSkin {

/// Gives each node a name of its own, as Assimp knows nodes by their names: glTF by their numbers,
/// and two may be called alike. Joints keep theirs before nodes that are none; what must change
/// gets a counter, as "Torso.001". A root for several roots gets a name of its own, too.
void nameNodes(GltfFile& file);

} // namespace osgSkin

#endif
