// SPDX-License-Identifier: MIT
#include "Figures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace twist {

FigureMaker::FigureMaker(const Cylinder& cylinder)
    : _cylinder(cylinder), _triangles(cylinder.mesh.triangles()),
      _edges(compare::faceEdges(cylinder.mesh.faceSizes, cylinder.mesh.faceVertices)) {
    for (const auto& ring : cylinder.rings) _side.insert(_side.end(), ring.begin(), ring.end());
}

Figures FigureMaker::measure(const std::vector<glm::dvec3>& posed, const TwistPose& pose) const {
    const std::vector<glm::dvec3>& rest = _cylinder.mesh.positions;
    Figures figures;
    figures.volume =
        compare::enclosedVolume(posed, _triangles) / compare::enclosedVolume(rest, _triangles);
    const auto area = [&](const std::vector<std::uint32_t>& ring) {
        return compare::loopArea(posed, ring) / compare::loopArea(rest, ring);
    };
    for (const auto& ring : _cylinder.rings)
        figures.leastArea = std::min(figures.leastArea, area(ring));
    figures.jointArea = area(_cylinder.jointRing());
    const glm::dvec3 joint(0.0);
    const glm::dvec3 up(0.0, 0.0, Cylinder::kHalfLength);
    figures.bulge = compare::bulge(rest, posed, _side, {{-up, joint}, {joint, up}},
                                   {{-up, joint}, {joint, pose.rotation() * up}});
    figures.strain = compare::edgeStrain(rest, posed, _edges);
    return figures;
}

double linearBlendJointArea(const TwistPose& pose) {
    // (1 + R) / 2 turns by theta / 2 and shrinks by c = cos(theta / 2) perpendicular to R's axis.
    // An area's normal goes by the cofactors: c across the axis, c^2 along it.
    const glm::dquat q = pose.rotation();
    const double c = std::abs(q.w);
    const double sine = glm::length(glm::dvec3(q.x, q.y, q.z));
    const double along = sine > 0.0 ? q.z / sine : 1.0;
    return std::hypot(c * c * along, c * std::sqrt(std::max(0.0, 1.0 - along * along)));
}

} // namespace twist
