// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MISSINGBONES_H
#define OSGSKINIMPORT_MISSINGBONES_H 1

#include <assimp/scene.h>

#include <string>

namespace osgSkin {

/// Gives a node to each bone that the file has painted weights for and no node, so that what hangs
/// on it can move: it follows, as its child, the bone of the same mesh that it shares most
/// weight with, and stands to it as in the bind pose. Says so in a notice.
void addMissingBones(aiScene& scene, const std::string& path);

} // namespace osgSkin

#endif
