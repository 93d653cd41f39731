// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TRUSTEDBONES_H
#define OSGSKINIMPORT_TRUSTEDBONES_H 1

#include <assimp/scene.h>

#include <vector>

namespace osgSkin {

class SceneBind;

/// The bones of a mesh whose offset matrices tell where they were bound: those that carry weights,
/// and of the others those that agree with them. Exporters list helper joints, which nobody
/// weights, with the identity or whatever else was at hand; such a bone may be the topmost.
///
/// An unweighted bone agrees where the mesh comes to the same size by it, and where it is as far
/// from a weighted bone near it as their nodes are; with the identity for its offset, the mesh must
/// come to stand the same way round, too.
///
/// \param mesh any
/// \param bind whose nodes and their poses are known already
/// \return bones with a node and an offset matrix that can be inverted; where none is weighted, all
std::vector<const aiBone*> reliableInverseBinds(const aiMesh& mesh, const SceneBind& bind);

} // namespace osgSkin

#endif
