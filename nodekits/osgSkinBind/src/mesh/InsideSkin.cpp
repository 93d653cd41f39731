// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/InsideSkin.h"

#include "mesh/AngleSum.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    AngleSum halves;
    for (const auto& t : mesh.triangles) {
        // The triangle's solid angle by van Oosterom and Strackee (1983).
        const glm::dvec3 a = mesh.positions[t[0]] - point;
        const glm::dvec3 b = mesh.positions[t[1]] - point;
        const glm::dvec3 c = mesh.positions[t[2]] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const double numerator = glm::dot(a, glm::cross(b, c));
        const double denominator =
            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
        halves.add(numerator, denominator);
    }
    // Half of a half sphere's solid angle.
    constexpr double kLeast = 3.141592653589793;
    return std::abs(halves.value()) > kLeast;
}

} // namespace osgSkin
