// SPDX-License-Identifier: GPL-3.0-or-later
//
// Areas of sections across a bent limb.
#include "correctives/JointSections.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace osgSkin;

namespace {

constexpr double kLimbRadius = 0.5;
constexpr std::uint32_t kLimbSides = 24;

/// A straight limb along y of 12 radii around the origin, a regular polygon in section.
ShapedJoint straightLimb() {
    ShapedJoint joint;
    joint.twistAxis = joint.bone = joint.above = {0, 1, 0};
    joint.hinge = {1, 0, 0};
    joint.radius = kLimbRadius;
    constexpr std::uint32_t kLimbRings = 25;
    for (std::uint32_t ring = 0; ring < kLimbRings; ++ring)
        for (std::uint32_t i = 0; i < kLimbSides; ++i) {
            const double angle = 2.0 * glm::pi<double>() * i / kLimbSides;
            const double y = kLimbRadius * (0.5 * ring - 6.0);
            joint.vertices.push_back(
                {ring * kLimbSides + i,
                 {kLimbRadius * std::cos(angle), y, kLimbRadius * std::sin(angle)},
                 y > 0.0 ? 1.0 : 0.0,
                 0.0,
                 1.0,
                 1.0});
            if (ring == 0) continue;
            const std::uint32_t a = (ring - 1) * kLimbSides, b = a + kLimbSides;
            const std::uint32_t next = (i + 1) % kLimbSides;
            joint.triangles.push_back({a + i, b + i, b + next});
            joint.triangles.push_back({a + i, b + next, a + next});
        }
    return joint;
}

double polygonArea() {
    return 0.5 * kLimbSides * std::sin(2.0 * glm::pi<double>() / kLimbSides) * kLimbRadius *
           kLimbRadius;
}

TEST(JointSections, HaveTheAreasOfAStraightLimb) {
    const ShapedJoint joint = straightLimb();
    const JointSections sections(joint);
    for (std::size_t k = 0; k < JointSections::kCount; ++k) {
        EXPECT_NEAR(sections.atRest().child[k], polygonArea(), 1e-9) << k;
        EXPECT_NEAR(sections.atRest().parent[k], polygonArea(), 1e-9) << k;
    }
    EXPECT_NEAR(sections.childDepth(), 0.5, 1e-9);
}

TEST(JointSections, FollowTheBentBone) {
    const ShapedJoint joint = straightLimb();
    const JointSections sections(joint);
    const glm::dquat turn = glm::angleAxis(glm::radians(60.0), glm::dvec3(1, 0, 0));
    std::vector<glm::dvec3> posed;
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        posed.push_back(vertex.bend > 0.5 ? turn * vertex.from : vertex.from);
    const JointSections::Sides areas = sections.areasOf(joint.above, turn * joint.bone, posed);
    // Beyond the fold, which is radius * tan(30 degrees) deep.
    for (std::size_t k = 2; k < JointSections::kCount; ++k) {
        EXPECT_NEAR(areas.child[k], polygonArea(), 1e-9) << k;
        EXPECT_NEAR(areas.parent[k], polygonArea(), 1e-9) << k;
    }
}

TEST(JointSections, ValuesEndBeyondTheLastSection) {
    JointSections::Values values;
    values.fill(0.3);
    const double last = JointSections::kStep * JointSections::kCount;
    EXPECT_NEAR(JointSections::valueAt(values, 0.0), 0.3, 1e-12);
    EXPECT_NEAR(JointSections::valueAt(values, last - JointSections::kStep), 0.3, 1e-12);
    EXPECT_NEAR(JointSections::valueAt(values, last + 2.0 * JointSections::kStep), 0.0, 1e-12);
    EXPECT_LT(JointSections::valueAt(values, last), 0.3);
}

} // namespace
