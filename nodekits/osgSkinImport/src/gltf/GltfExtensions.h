// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFEXTENSIONS_H
#define OSGSKINIMPORT_GLTFEXTENSIONS_H 1

#include "gltf/GltfAccessors.h"
#include "gltf/GltfFile.h"

namespace osgSkin {

/// Says in a notice what the file requires that is not known to leave shapes and motions alone.
/// Compressions are no part of it: see unpackMeshopt(); Draco is Assimp's, which refuses it where
/// it was built without.
void noteExtensions(const GltfFile& file);

/// Moves texture coordinates as the textures of their materials say (KHR_texture_transform).
void moveTexCoords(GltfFile& file, GltfAccessors& accessors);

/// Whether the front of the file's figure is -Z: VRM 0 turned it so, where glTF has +Z.
bool facesBackwards(const GltfFile& file);

} // namespace osgSkin

#endif
