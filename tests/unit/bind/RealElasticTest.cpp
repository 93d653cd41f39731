// SPDX-License-Identifier: GPL-3.0-or-later
// A real body's elbow, bent to 129 and 139 degrees of total flexion.
#include "SharedBody.h"

#include "elastic/SolveElastic.h"
#include <osgSkinBind/Bind>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace {

using namespace osgSkin;

/// Corners of equal position as one.
std::vector<std::array<std::uint32_t, 3>> weldedTriangles(const SkinMesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        first.push_back(known.try_emplace({p.x, p.y, p.z}, v).first->second);
    }
    const std::vector<std::uint32_t> corners = mesh.triangles();
    std::vector<std::array<std::uint32_t, 3>> result;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
        result.push_back({first[corners[t]], first[corners[t + 1]], first[corners[t + 2]]});
    return result;
}

} // namespace

TEST(RealElastic, ElbowFoldsWithoutCrossings) {
    const auto body = shared::makehuman() / "body/body4k_neutral.obj";
    if (!std::filesystem::exists(body)) GTEST_SKIP() << body << " is not here";
    const SkinMesh mesh = shared::readObj(body);
    const RestSkeleton rig =
        shared::readJoints(shared::makehuman() / "rig/joints_cmu_mb_neutral.json");
    const Binding binding = bind(mesh, rig);
    const auto elbow = static_cast<std::size_t>(rig.find("LeftForeArm"));
    const glm::dvec3 centre = rig.joints[elbow].centre, pole = binding.joints[elbow].boneAxis;
    const glm::dvec3 shoulder =
        rig.joints[static_cast<std::size_t>(rig.joints[elbow].parent)].centre;
    const glm::dvec3 hand = rig.joints[static_cast<std::size_t>(rig.find("LeftHand"))].centre;

    ElasticJoint joint;
    joint.name = "LeftForeArm";
    joint.centre = centre;
    joint.radius = 0.386; // where the bend is halfway
    joint.hinge = true;
    joint.bones = {{shoulder, centre, false}, {centre, hand, true}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        double ratio = 0.0;
        for (std::size_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == elbow) ratio = double(binding.influences[i].bend);
        joint.ratios.push_back(ratio);
    }
    const glm::dvec3 above = glm::normalize(centre - shoulder);
    const glm::dvec3 axis = glm::normalize(glm::cross(above, pole));
    const double rest = std::acos(glm::dot(above, pole));
    for (const double total : {129.0, 139.0})
        joint.samples.push_back(glm::angleAxis(glm::radians(total) - rest, axis));

    const auto triangles = weldedTriangles(mesh);
    const ElasticShapes shapes = solveElasticJoint({mesh.positions, triangles}, joint);
    ASSERT_EQ(shapes.reason, "");
    for (const ElasticSample& sample : shapes.samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_LE(10 * sample.crossings, sample.plainCrossings);
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_GT(sample.volumeRatio, 0.95);
    }
    EXPECT_GT(shapes.samples.back().plainCrossings, 20u);

    // Vertices that the elbow does not reach, and the hand's, move as their bones do.
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (glm::length(shapes.rest[i] - centre) < 0.97 * shapes.reach) continue;
        const glm::dvec3 turned =
            centre + glm::mat3_cast(shapes.samples[0].rotation) * (shapes.rest[i] - centre);
        const glm::dvec3 expected =
            joint.ratios[shapes.vertices[i]] > 0.5 ? turned : shapes.rest[i];
        EXPECT_LT(glm::length(shapes.samples[0].positions[i] - expected), 0.02 * joint.radius);
    }
}
