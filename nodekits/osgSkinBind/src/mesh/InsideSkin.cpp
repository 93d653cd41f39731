// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/InsideSkin.h"

#include "mesh/AngleSum.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace osgSkin {
namespace {

/// A vertex from the point that is looked at.
struct Seen {
    glm::dvec3 from;
    double away;
};

/// Adds half of a triangle's solid angle, by van Oosterom and Strackee (1983).
void addAngle(const std::vector<Seen>& seen, const std::array<std::uint32_t, 3>& t,
              AngleSum& halves) {
    const Seen &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
    const double numerator = glm::dot(a.from, glm::cross(b.from, c.from));
    const double denominator = a.away * b.away * c.away + glm::dot(a.from, b.from) * c.away +
                               glm::dot(b.from, c.from) * a.away +
                               glm::dot(c.from, a.from) * b.away;
    halves.add(numerator, denominator);
}

/// Half of a whole sphere's solid angle, less what rounding takes.
constexpr double kAllAround = 6.28;

} // namespace

bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    std::vector<Seen> seen;
    seen.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) seen.push_back({p - point, glm::length(p - point)});
    AngleSum halves;
    for (const auto& t : mesh.triangles) addAngle(seen, t, halves);
    // Half of a half sphere's solid angle.
    constexpr double kLeast = 3.141592653589793;
    return std::abs(halves.value()) > kLeast;
}

std::vector<std::uint32_t> shellsAround(const WeldedMesh& mesh, const glm::dvec3& point) {
    std::vector<Seen> seen;
    seen.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) seen.push_back({p - point, glm::length(p - point)});
    std::vector<AngleSum> halves(mesh.shells);
    for (const auto& t : mesh.triangles) addAngle(seen, t, halves[mesh.shellOf[t[0]]]);
    std::vector<std::uint32_t> result;
    for (std::uint32_t shell = 0; shell < mesh.shells; ++shell)
        if (std::abs(halves[shell].value()) > kAllAround) result.push_back(shell);
    return result;
}

} // namespace osgSkin
