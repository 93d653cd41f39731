// SPDX-License-Identifier: MIT
#pragma once

#include "Tube.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Pose>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <vector>

namespace test {

/// A tube with ratios and their gradients known everywhere along it, not only at its vertices.
struct SlopedTube : Tube {
    explicit SlopedTube(int rings = 25, int sides = 12) : Tube(rings, sides) {
        for (std::uint32_t v = 0; v < positions.size(); ++v)
            for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1];
                 ++i) {
                const double height = double(positions[v].y);
                const osgSkin::RatioGradient gradient = {
                    glm::vec3(0.0f, slope(&Ratios::bend, i, height), 0.0f),
                    glm::vec3(0.0f, slope(&Ratios::twist, i, height), 0.0f)};
                binding.gradients.push_back(gradient);
            }
    }

    /// Sorts the vertices so that the deformation writes its results in order.
    void bringIntoOrder() {
        const std::vector<glm::vec3> oldPositions = positions, oldNormals = normals;
        source = osgSkin::SkinModel::bestOrder(binding, source);
        for (std::size_t i = 0; i < source.size(); ++i) {
            positions[i] = oldPositions[source[i]];
            normals[i] = oldNormals[source[i]];
        }
    }

    /// Three rotated joints, one of them scaled about its centre.
    std::vector<osgSkin::JointMap> scaledMaps(std::size_t scaled, double scale) const {
        std::vector<osgSkin::JointMap> maps(3);
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3& centre = binding.joints[j].centre;
            maps[j].rotation = glm::angleAxis(0.7, glm::dvec3(1, 0, 0));
            maps[j].scale = j == scaled ? scale : 1.0;
            maps[j].offset = centre - maps[j].scale * (maps[j].rotation * centre);
        }
        return maps;
    }

    struct Ratios {
        double bend, twist;
    };
    static Ratios ratiosOf(std::uint32_t joint, double height) {
        if (joint == 0) return {1.0, 1.0};
        if (joint == 1) return {rise(height, 1.0, 3.0), rise(height, 1.0, 3.0)};
        return {rise(height, 3.5, 4.5), rise(height, 2.5, 4.0)};
    }

    /// The posed position of any point near the tube.
    glm::dvec3 posed(const osgSkin::Pose& pose, glm::dvec3 x) const {
        const double height = x.y;
        for (std::uint32_t j = 3; j-- > 0;) {
            const osgSkin::JointTransform turn = pose.transform(j);
            const Ratios ratios = ratiosOf(j, height);
            const glm::dvec3& centre = binding.joints[j].centre;
            const glm::dvec3 from =
                osgSkin::partialRotation(turn.split, binding.joints[j].twistAxis, ratios.bend,
                                         ratios.twist) *
                (x - centre);
            // The root's translation is its offset.
            x = j == 0 ? turn.offset + turn.scale * (turn.rotation * x)
                       : centre + ratios.bend * turn.translation +
                             (1.0 + ratios.bend * (turn.scale - 1.0)) * from;
        }
        return x;
    }

    /// The posed image of a short displacement along the tube, per length.
    glm::dvec3 posedWay(const osgSkin::Pose& pose, const glm::dvec3& x,
                        const glm::dvec3& along) const {
        constexpr double kStep = 1e-5;
        return (posed(pose, x + kStep * along) - posed(pose, x - kStep * along)) / (2.0 * kStep);
    }

private:
    static double rise(double height, double low, double high) {
        const double t = std::clamp((height - low) / (high - low), 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }
    float slope(double Ratios::*which, std::uint32_t influence, double height) const {
        constexpr double step = 1e-5;
        const std::uint32_t joint = binding.influences[influence].joint;
        return static_cast<float>(
            (ratiosOf(joint, height + step).*which - ratiosOf(joint, height - step).*which) /
            (2.0 * step));
    }
};

} // namespace test
