// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/InsideSkin.h"

#include "mesh/AngleSum.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace osgSkin {
namespace {

/// A vertex from the point that is looked at.
struct Seen {
    glm::dvec3 from;
    double away;
};

} // namespace

bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    std::vector<Seen> seen;
    seen.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) seen.push_back({p - point, glm::length(p - point)});
    AngleSum halves;
    for (const auto& t : mesh.triangles) {
        // The triangle's solid angle by van Oosterom and Strackee (1983).
        const Seen &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
        const double numerator = glm::dot(a.from, glm::cross(b.from, c.from));
        const double denominator = a.away * b.away * c.away + glm::dot(a.from, b.from) * c.away +
                                   glm::dot(b.from, c.from) * a.away +
                                   glm::dot(c.from, a.from) * b.away;
        halves.add(numerator, denominator);
    }
    // Half of a half sphere's solid angle.
    constexpr double kLeast = 3.141592653589793;
    return std::abs(halves.value()) > kLeast;
}

} // namespace osgSkin
