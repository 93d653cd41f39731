// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFEXTENSIONS_H
#define OSGSKINIMPORT_GLTFEXTENSIONS_H 1

#include "gltf/GltfFile.h"

namespace osgSkin {

/// Refuses what is compressed in a way that nobody here can undo, by its name: meshopt, and where
/// Assimp was built without it, Draco is refused by Assimp. Says in a notice what else the file
/// requires that is not known to leave shapes and motions alone.
/// \throw osgSkin::Error with the file and the compression
void checkExtensions(const GltfFile& file);

/// Whether the front of the file's figure is -Z: VRM 0 turned it so, where glTF has +Z.
bool facesBackwards(const GltfFile& file);

} // namespace osgSkin

#endif
