// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SkinMesh.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace mannequin {

/// Bounds that a good skin keeps.
struct MeshBounds {
    std::size_t leastVertices, mostVertices;
    double leastAngle;    ///< degrees
    double mostDeviation; ///< metres
};

/// Checks that a skin can be deformed: one closed manifold without folds or slivers, around its
/// bones.
struct MeshReport {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    int eulerCharacteristic = 0;
    bool closed = false;            ///< one component, valid halfedges, no border
    std::size_t intersections = 0;  ///< pairs of faces that cut each other
    double smallestAngle = 0;       ///< of all triangles, degrees
    std::size_t smallAngles = 0;    ///< triangles with an angle below 20 degrees
    double lowest = 0, highest = 0; ///< metres
    double deviation = 0;           ///< largest distance of a model vertex from the mesh, metres
    glm::dvec3 worstPlace{0};       ///< position of that vertex
    std::vector<std::string> jointsOutside;

    /// True if the mesh has every property required.
    bool good(const MeshBounds& bounds) const;
};

/// Inspects a mesh. `model` is a fine triangulation of the surface that it approximates.
MeshReport inspect(const SkinMesh& mesh, const SkinMesh& model);

std::ostream& operator<<(std::ostream& out, const MeshReport& report);

} // namespace mannequin
