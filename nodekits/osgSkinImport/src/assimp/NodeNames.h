// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_NODENAMES_H
#define OSGSKINIMPORT_NODENAMES_H 1

#include <assimp/scene.h>

#include <set>
#include <string>

namespace osgSkin {

/// Makes the names of a scene's nodes unique, since bones and tracks know their nodes by name: of
/// several nodes, they mean one that holds no mesh. The others get a counter behind the name.
///
/// FBX files name a mesh and its bone alike; Assimp then calls the second of them "Torso001" and
/// lets the bone mean the first. Where that is the mesh, the two change names.
void separateNames(aiScene& scene, const std::string& path);

/// The names of all meshes' bones.
std::set<std::string> boneNames(const aiScene& scene);

} // namespace osgSkin

#endif
