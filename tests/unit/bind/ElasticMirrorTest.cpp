// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two tubes side by side, like two legs.
#include "ElasticTube.h"
#include "elastic/SolveElastic.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

using namespace osgSkin;

namespace {

const glm::dvec3 kLeft(7.0, 1.0, 2.0), kRight(-5.0, 1.0, 2.0);

glm::dvec3 mirrored(const glm::dvec3& p) {
    return {2.0 - p.x, p.y, p.z};
}

class ElasticMirror : public ::testing::Test {
protected:
    ElasticMirror() {
        joints = {jointOf(left), jointOf(right)};
        const auto count = static_cast<std::uint32_t>(left.positions.size());
        joints[0].ratios.insert(joints[0].ratios.end(), count, 0.0);
        joints[1].ratios.insert(joints[1].ratios.begin(), count, 0.0);
        positions.insert(positions.end(), right.positions.begin(), right.positions.end());
        for (const auto& [a, b, c] : right.triangles)
            triangles.push_back({a + count, b + count, c + count});
    }

    static ElasticJoint jointOf(const ElasticTube& tube) { return tube.joint({-25, 25, 50}); }

    /// \return the number of progress reports
    std::size_t solve() {
        std::size_t told = 0;
        shapes = solveElasticJoints({positions, triangles}, joints,
                                    [&told](const ProgressStep&) { ++told; });
        return told;
    }

    ElasticTube left{1.0, kLeft}, right{1.0, kRight};
    std::vector<glm::dvec3> positions = left.positions;
    std::vector<std::array<std::uint32_t, 3>> triangles = left.triangles;
    std::vector<ElasticJoint> joints;
    std::vector<ElasticShapes> shapes;
};

} // namespace

TEST_F(ElasticMirror, OneSideIsSolvedAndServesBoth) {
    EXPECT_LE(solve(), 3u) << "samples of one joint";
    const ElasticShapes& solved = shapes[0];
    const ElasticShapes& other = shapes[1];
    ASSERT_EQ(other.reason, "");
    EXPECT_EQ(other.seconds, 0.0);
    ASSERT_EQ(other.samples.size(), 3u);
    EXPECT_GT(other.vertices.size(), solved.vertices.size() * 9 / 10);
    const ElasticShapes alone = solveElasticJoint({positions, triangles}, joints[1]);
    double moved = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
        EXPECT_EQ(other.samples[s].rotation, joints[1].samples[s]);
        ASSERT_EQ(other.samples[s].positions.size(), other.vertices.size());
        for (std::size_t i = 0; i < other.vertices.size(); ++i) {
            const std::uint32_t v = other.vertices[i];
            EXPECT_EQ(other.rest[i], positions[v]);
            const auto found = std::lower_bound(alone.vertices.begin(), alone.vertices.end(), v);
            ASSERT_TRUE(found != alone.vertices.end() && *found == v);
            const auto at = static_cast<std::size_t>(found - alone.vertices.begin());
            EXPECT_LT(glm::distance(other.samples[s].positions[i], alone.samples[s].positions[at]),
                      5e-3);
            moved = std::max(moved, glm::distance(other.samples[s].positions[i], other.rest[i]));
        }
    }
    EXPECT_GT(moved, 1.0);
}

TEST_F(ElasticMirror, SamplesOfTheOtherSideMayComeInAnotherOrder) {
    std::swap(joints[1].samples[0], joints[1].samples[2]);
    EXPECT_LE(solve(), 3u);
    for (std::size_t s = 0; s < 3; ++s)
        EXPECT_EQ(shapes[1].samples[s].rotation, joints[1].samples[s]);
    const glm::dvec3 top = shapes[0].samples[0].positions.back();
    const auto& positionsOfOther = shapes[1].samples[2].positions;
    EXPECT_TRUE(
        std::any_of(positionsOfOther.begin(), positionsOfOther.end(),
                    [&](const glm::dvec3& p) { return glm::distance(p, mirrored(top)) < 0.05; }));
}

TEST_F(ElasticMirror, BothSidesAreSolvedWhereSomethingDiffers) {
    using Joint = ElasticJoint;
    using Skin = std::vector<glm::dvec3>;
    const struct {
        const char* what;
        void (*change)(Joint& joint, Skin& skin);
    } cases[] = {
        {"a bone", [](Joint& joint, Skin&) { joint.bones[1].to.z += 0.5; }},
        {"what a bone follows", [](Joint& joint, Skin&) { joint.bones[0].moves = true; }},
        {"a sample", [](Joint& joint, Skin&) { joint.samples[0] = glm::dquat(1, 0, 0, 0); }},
        {"the radius", [](Joint& joint, Skin&) { joint.radius *= 1.2; }},
        {"ratios",
         [](Joint& joint, Skin&) {
             for (double& ratio : joint.ratios) ratio *= 0.8;
         }},
        {"the skin",
         [](Joint& joint, Skin& skin) {
             for (glm::dvec3& p : skin)
                 if (p.x < 1.0) p.z = joint.centre.z + 1.2 * (p.z - joint.centre.z);
         }},
    };
    for (const auto& each : cases) {
        const auto before = std::make_pair(joints, positions);
        each.change(joints[1], positions);
        solve();
        EXPECT_GT(shapes[1].seconds, 0.0) << each.what;
        std::tie(joints, positions) = before;
    }
}
