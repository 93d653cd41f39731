// SPDX-License-Identifier: GPL-3.0-or-later
//
// The reach of shapes around joints: shorter if something else is close.
#include "SharedBody.h"
#include "correctives/ShapedJoint.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <joints/JointPlan.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

namespace {

const Armpit pit{{1.5, 2.25}, {0.0, 1.0, 0.0}}; // the trunk is below

/// The farthest vertices that a joint's shapes move while its pit is closed, in radii: those more
/// than 30 degrees from the plane across the limb towards the trunk, and those on the other side.
struct Farthest {
    double pit = 0.0, away = 0.0;
};

Farthest farthestOf(const ShapedJoint& shaped, const glm::dvec3& root) {
    glm::dvec3 away = shaped.centre - root;
    away = glm::normalize(away - shaped.bone * glm::dot(away, shaped.bone));
    Farthest result;
    for (const ShapedJoint::Vertex& vertex : shaped.vertices) {
        EXPECT_GE(vertex.fade, vertex.fadeClosed);
        if (vertex.fadeClosed * vertex.limb <= 0.0) continue;
        const double length = glm::length(vertex.from);
        const double lean = -glm::dot(vertex.from, away) / length;
        double& most = lean > 0.5 ? result.pit : result.away;
        if (lean > 0.5 || lean < 0.0) most = std::max(most, length / shaped.radius);
    }
    return result;
}

} // namespace

TEST(ShapeReach, FallsFromOneToZero) {
    const ShapeReach reach{2.0, 4.0};
    EXPECT_EQ(reach.shareAt(0.0), 1.0);
    EXPECT_EQ(reach.shareAt(2.0), 1.0);
    EXPECT_NEAR(reach.shareAt(3.0), 0.5, 1e-12);
    EXPECT_EQ(reach.shareAt(4.0), 0.0);
    EXPECT_EQ(reach.shareAt(9.0), 0.0);
    for (double r = 2.0; r < 4.0; r += 0.1) EXPECT_GE(reach.shareAt(r), reach.shareAt(r + 0.1));
}

TEST(ShapeReach, IsShorterTowardsTheArmpit) {
    const ShapeReach reach{2.0, 4.0};
    const auto endAt = [&](double degrees) { // below the plane across `away`
        const double angle = degrees / 180.0 * std::acos(-1.0);
        return reachTowards({3.0 * std::cos(angle), -3.0 * std::sin(angle), 0.0}, reach, pit).end;
    };
    EXPECT_EQ(endAt(-80.0), 4.0);
    EXPECT_EQ(endAt(0.0), 4.0);
    EXPECT_LT(endAt(15.0), 4.0);
    EXPECT_GT(endAt(15.0), 2.25);
    EXPECT_NEAR(endAt(30.0), 2.25, 1e-9);
    EXPECT_EQ(endAt(90.0), 2.25);
    EXPECT_EQ(reachTowards({0.0, -1.0, 0.0}, reach, pit).whole, 1.5);
}

TEST(ShapeReach, IsUniformWithoutAnArmpit) {
    const ShapeReach reach{2.0, 4.0};
    const Armpit none{{1.5, 2.25}};
    EXPECT_EQ(reachTowards({0.0, -1.0, 0.0}, reach, none).end, 4.0);
    EXPECT_EQ(reachTowards({0.0, 0.0, 0.0}, reach, pit).end, 4.0); // the joint itself
}

TEST(ShapeReach, ArmpitOpensWhenTheLimbIsRaised) {
    ShapedJoint joint;
    joint.functions.axis = {0.0, 0.0, 1.0};
    joint.twistAxis = joint.bone = {1.0, 0.0, 0.0}; // sideways
    joint.away = {0.0, 1.0, 0.0};
    const auto closedAt = [&](double degrees) { // raised by these degrees
        return joint.armpitClosure(
            joint.bendAt({std::sin(0.5 * degrees / 180.0 * std::acos(-1.0)), 0.0}));
    };
    EXPECT_EQ(closedAt(60.0), 0.0);
    EXPECT_EQ(closedAt(90.0), 0.0);
    EXPECT_GT(closedAt(0.0), 0.5);
    EXPECT_GT(closedAt(0.0), closedAt(20.0));
    EXPECT_EQ(closedAt(-20.0), 1.0);
    EXPECT_EQ(closedAt(-80.0), 1.0);
}

TEST(ShapeReach, EndsEarlierInArmpitsAndAtHips) {
    const auto obj = shared::makehuman() / "body/body4k_neutral.obj";
    if (!std::filesystem::exists(obj)) GTEST_SKIP() << obj << " is not here";
    const SkinMesh mesh = shared::readObj(obj);
    const RestSkeleton rig =
        shared::readJoints(shared::makehuman() / "rig/joints_cmu_mb_neutral.json");
    const WeldedMesh skin(mesh);
    std::vector<std::string> notes;
    ShapeScope scope;
    scope.trunkToo = true;
    scope.atTrunk = {2.0, 4.0};
    scope.besideLimb = {2.0, 3.0};
    scope.inPit = {1.5, 2.25};
    std::size_t arms = 0, legs = 0;
    for (const ShapedJoint& shaped :
         findShapedJoints(rig, planJoints(rig, skin, {}, notes), skin, bind(mesh, rig), scope)) {
        const std::string& name = rig.joints[shaped.functions.joint].name;
        const Farthest farthest = farthestOf(shaped, rig.joints[0].centre);
        if (name == "LeftArm" || name == "RightArm") {
            ++arms;
            EXPECT_LT(farthest.pit, 2.25 + 1e-9);
            EXPECT_GT(farthest.pit, 1.8);
            EXPECT_LT(farthest.away, 4.0);
            EXPECT_GT(farthest.away, 3.0);
        }
        if (name == "LeftUpLeg" || name == "RightUpLeg") {
            ++legs;
            EXPECT_LT(std::max(farthest.pit, farthest.away), 3.0);
            EXPECT_GT(std::max(farthest.pit, farthest.away), 2.5);
        }
    }
    EXPECT_EQ(arms, 2u);
    EXPECT_EQ(legs, 2u);
}
