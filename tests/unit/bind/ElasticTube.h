// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "elastic/SolveElastic.h"

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

/// A tube of radius `scale` along y, six radii to either side of the joint at `centre`; a positive
/// angle rotates its upper half towards +z.
class ElasticTube {
public:
    explicit ElasticTube(double scale = 1.0, const glm::dvec3& centre = glm::dvec3(0.0),
                         bool capped = true)
        : _scale(scale), _centre(centre) {
        constexpr std::uint32_t kSides = 20, kRings = 41;
        const auto at = [](std::uint32_t ring, std::uint32_t side) {
            return ring * kSides + side % kSides;
        };
        for (std::uint32_t ring = 0; ring < kRings; ++ring)
            for (std::uint32_t side = 0; side < kSides; ++side) {
                const double angle = 2.0 * glm::pi<double>() * side / kSides;
                add({std::cos(angle), 0.3 * ring - 6.0, -std::sin(angle)});
            }
        for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
            for (std::uint32_t side = 0; side < kSides; ++side) {
                triangles.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side + 1)});
                triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
            }
        if (!capped) return;
        const auto last = static_cast<std::uint32_t>(positions.size());
        add({0, -6, 0});
        add({0, 6, 0});
        for (std::uint32_t side = 0; side < kSides; ++side) {
            triangles.push_back({last, at(0, side + 1), at(0, side)});
            triangles.push_back({last + 1, at(kRings - 1, side), at(kRings - 1, side + 1)});
        }
    }

    osgSkin::ElasticSkin skin() const { return {positions, triangles}; }

    /// The tube's hinge, with samples in degrees.
    osgSkin::ElasticJoint joint(const std::vector<int>& angles) const {
        osgSkin::ElasticJoint joint;
        joint.name = "tube";
        joint.centre = _centre;
        joint.radius = _scale;
        joint.hinge = true;
        joint.bones = {{_centre - glm::dvec3(0, 6, 0) * _scale, _centre, false},
                       {_centre, _centre + glm::dvec3(0, 6, 0) * _scale, true}};
        for (const glm::dvec3& p : positions) {
            const double y = (p.y - _centre.y) / _scale;
            const double t = std::clamp((y + 1.5) / 3.0, 0.0, 1.0);
            joint.ratios.push_back(t * t * (3.0 - 2.0 * t)); // eq. 5
        }
        for (const int angle : angles)
            joint.samples.push_back(
                glm::angleAxis(glm::radians(double(angle)), glm::dvec3(1, 0, 0)));
        return joint;
    }

    std::vector<glm::dvec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

private:
    void add(const glm::dvec3& p) { positions.push_back(_centre + _scale * p); }

    double _scale;
    glm::dvec3 _centre;
};
