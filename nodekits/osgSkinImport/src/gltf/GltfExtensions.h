// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFEXTENSIONS_H
#define OSGSKINIMPORT_GLTFEXTENSIONS_H 1

#include "gltf/GltfFile.h"

namespace osgSkin {

/// Says in a notice what the file requires that is not known to leave shapes and motions alone.
/// Compressions are no part of it: see unpackMeshopt(); Draco is Assimp's, which refuses it where
/// it was built without.
void noteExtensions(const GltfFile& file);

/// Whether the front of the file's figure is -Z: VRM 0 turned it so, where glTF has +Z.
bool facesBackwards(const GltfFile& file);

} // namespace osgSkin

#endif
