// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SkinMesh.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace mannequin {

/// What a deformable skin must be: one closed manifold without folds and slivers, around its bones.
struct MeshReport {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    int eulerCharacteristic = 0;
    bool closed = false;            ///< valid halfedge structure without border, in one piece
    std::size_t intersections = 0;  ///< pairs of faces that cut each other
    double smallestAngle = 0;       ///< of any triangle, degrees
    std::size_t smallAngles = 0;    ///< triangles with an angle below 20 degrees
    double lowest = 0, highest = 0; ///< metres
    double deviation = 0;           ///< farthest of the model's vertices from the mesh, metres
    glm::dvec3 worstPlace{0};       ///< where that is
    std::vector<std::string> jointsOutside;

    /// True where every property holds that is asked of thrower.obj.
    bool good() const;
};

/// `model` is a fine triangulation of the surface that the mesh approximates.
MeshReport inspect(const SkinMesh& mesh, const SkinMesh& model);

std::ostream& operator<<(std::ostream& out, const MeshReport& report);

} // namespace mannequin
