// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smoothing of posed skin around a joint.
#include "correctives/SkinRelaxation.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace osgSkin;

namespace {

constexpr std::uint32_t kRound = 24, kRings = 33;

/// A tube along y of radius 1 and length 8 around the origin; its upper half bends.
ShapedJoint tube(bool isSoft, double relaxation) {
    ShapedJoint joint;
    joint.functions.basis = CorrectiveJoint::Basis::Ball;
    joint.twistAxis = joint.bone = joint.above = {0, 1, 0};
    joint.radius = 1.0;
    joint.isSoft = isSoft;
    joint.relaxation = relaxation;
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const double angle = 2.0 * glm::pi<double>() * i / kRound, y = ring * 0.25 - 4.0;
            const double bend = glm::clamp(0.5 + 0.5 * y, 0.0, 1.0);
            joint.vertices.push_back(
                {ring * kRound + i, {std::cos(angle), y, std::sin(angle)}, bend, bend, 1.0, 1.0});
        }
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const std::uint32_t next = (i + 1) % kRound, a = ring * kRound, b = a + kRound;
            joint.triangles.push_back({a + i, b + i, b + next});
            joint.triangles.push_back({a + i, b + next, a + next});
        }
    return joint;
}

BendTwist bentBy(double degrees) {
    BendTwist bend;
    bend.bendAxis = {1, 0, 0};
    bend.bendAngle = glm::radians(degrees);
    return bend;
}

std::vector<glm::dvec3> posed(const ShapedJoint& joint, const BendTwist& bend) {
    std::vector<glm::dvec3> points;
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        points.push_back(joint.turnOf(vertex, bend) * vertex.from);
    return points;
}

double largestMove(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, glm::distance(a[i], b[i]));
    return most;
}

} // namespace

TEST(SkinRelaxation, KeepsTheRestPose) {
    for (const bool isSoft : {false, true}) {
        const ShapedJoint joint = tube(isSoft, 0.5);
        const std::vector<glm::dvec3> rest = posed(joint, bentBy(0.0));
        EXPECT_LT(
            largestMove(SkinRelaxation(joint).relaxed(rest, joint.turnsOf(bentBy(0.0))), rest),
            1e-9);
    }
}

TEST(SkinRelaxation, KeepsSkinThatIsRigidAndFarFromTheBend) {
    const ShapedJoint joint = tube(true, 0.3);
    const BendTwist bend = bentBy(60.0);
    const std::vector<glm::dvec3> before = posed(joint, bend);
    const std::vector<glm::dvec3> after =
        SkinRelaxation(joint).relaxed(before, joint.turnsOf(bend));
    for (std::size_t v = 0; v < before.size(); ++v)
        if (std::abs(joint.vertices[v].from.y) > 3.0) {
            EXPECT_LT(glm::distance(after[v], before[v]), 1e-3) << v;
        }
}

TEST(SkinRelaxation, RoundsTheSkinOfSoftJoints) {
    const ShapedJoint joint = tube(true, 0.5);
    const BendTwist bend = bentBy(60.0);
    std::vector<glm::dvec3> points = posed(joint, bend);
    const std::size_t peak = kRings / 2 * kRound;
    const glm::dvec3 before = points[peak];
    points[peak] *= 1.3; // a spike
    const std::vector<glm::dvec3> after =
        SkinRelaxation(joint).relaxed(points, joint.turnsOf(bend));
    EXPECT_LT(glm::distance(after[peak], before), 0.5 * glm::distance(points[peak], before));
}

TEST(SkinRelaxation, SmoothsOtherJointsWhereTheyAreCompressedAlone) {
    const ShapedJoint joint = tube(false, 0.35);
    const BendTwist bend = bentBy(120.0);
    const std::vector<glm::dvec3> before = posed(joint, bend);
    const std::vector<glm::dvec3> after =
        SkinRelaxation(joint).relaxed(before, joint.turnsOf(bend));
    double inside = 0.0, outside = 0.0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        const glm::dvec3& from = joint.vertices[v].from;
        if (std::abs(from.y) > 1.0 || std::abs(from.z) < 0.9) continue;
        // A positive bend about x closes the side of positive z.
        double& most = from.z > 0.0 ? inside : outside;
        most = std::max(most, glm::distance(after[v], before[v]));
    }
    EXPECT_GT(inside, 0.04);
    EXPECT_LT(outside, 0.2 * inside);
}

TEST(SkinRelaxation, LeavesJointsWithoutRelaxationAlone) {
    const ShapedJoint joint = tube(true, 0.0);
    const BendTwist bend = bentBy(60.0);
    const std::vector<glm::dvec3> points = posed(joint, bend);
    EXPECT_EQ(SkinRelaxation(joint).relaxed(points, joint.turnsOf(bend)), points);
}
