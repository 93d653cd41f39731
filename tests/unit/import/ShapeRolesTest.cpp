// SPDX-License-Identifier: MIT
// Joints with meaningless names, recognised by the skeleton's shape.
#include "Figure.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/RetargetReport>

#include <gtest/gtest.h>
#include <osgAnimation/Bone>

#include <string>

using namespace osgSkin;

namespace {

RestSkeleton nameless(RestSkeleton skeleton) {
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
        skeleton.joints[j].name = "Bone." + std::to_string(100 + j);
    return skeleton;
}

/// Joints that the shape gives another role than their names do, among those that every body has.
std::string wrongByShape(const RestSkeleton& body, const JointRoles& told) {
    const JointRoles named = recogniseJoints(body);
    std::string result;
    for (const char* role :
         {"Hips", "Head", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg",
          "RightLowerLeg", "RightFoot", "LeftUpperArm", "LeftLowerArm", "LeftHand", "RightUpperArm",
          "RightLowerArm", "RightHand"}) {
        const auto found = told.joints.find(role);
        const int theirs = found == told.joints.end() ? -1 : found->second[0];
        if (theirs != named.joints.at(role)[0])
            result += std::string(role) + " is " +
                      (theirs < 0 ? "none" : body.joints[std::size_t(theirs)].name) + "; ";
    }
    return result;
}

/// A body with 60 chains of three bones around its hips, as long as its thighs.
RestSkeleton skirted(RestSkeleton body, const JointRoles& roles, double length) {
    const int hips = roles.joints.at("Hips")[0];
    const glm::dvec3 from = body.joints[std::size_t(hips)].centre;
    for (int i = 0; i < 60; ++i) {
        const double angle = glm::radians(6.0 * i);
        const glm::dvec3 way(0.4 * std::cos(angle), -0.9, 0.4 * std::sin(angle));
        int parent = hips;
        for (int part = 1; part <= 3; ++part)
            parent = body.add("skirt" + std::to_string(i) + "_" + std::to_string(part), parent,
                              from + length * part / 3.0 * glm::normalize(way));
    }
    return body;
}

class ShapeRoles : public testing::TestWithParam<const char*> {
protected:
    RestSkeleton body() const {
        const std::string path = GetParam();
        return importSkeleton(path[0] == '/' ? path : sharedData(path));
    }
    bool missing() const {
        const std::string path = GetParam();
        return !std::filesystem::exists(path[0] == '/' ? path : sharedData(path));
    }
};

} // namespace

TEST_P(ShapeRoles, FindsTheMainJoints) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    const RestSkeleton standing = body();
    const JointRoles told = recogniseJoints(nameless(standing));
    EXPECT_EQ(told.family, kInferredFromGeometry);
    EXPECT_EQ(wrongByShape(standing, told), "");
}

TEST_P(ShapeRoles, FindsJointsBelowASkirt) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    RestSkeleton standing = body();
    const JointRoles bare = recogniseJoints(standing);
    const glm::dvec3 hips = standing.joints[std::size_t(bare.joints.at("Hips")[0])].centre;
    const int knee = bare.joints.at("LeftLowerLeg")[0];
    const double length = glm::distance(hips, standing.joints[std::size_t(knee)].centre);
    const JointRoles told = recogniseJoints(nameless(skirted(standing, bare, length)));
    EXPECT_EQ(wrongByShape(standing, told), "");
}

TEST_P(ShapeRoles, AreIndependentOfOrientation) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    RestSkeleton turned = body();
    const glm::dquat turn = turnDegrees(90.0, {1, 0, 0}) * turnDegrees(140.0, {0, 1, 0});
    for (RestJoint& joint : turned.joints) {
        joint.centre = 0.01 * (turn * joint.centre) + glm::dvec3(3, 4, 5);
        if (joint.tip) joint.tip = 0.01 * (turn * *joint.tip) + glm::dvec3(3, 4, 5);
    }
    EXPECT_EQ(wrongByShape(turned, recogniseJoints(nameless(turned))), "");
}

INSTANTIATE_TEST_SUITE_P(Bodies, ShapeRoles,
                         testing::Values(OSGSKIN_DATA "/thrower.bvh",
                                         "makehuman/rig/cmu_mb_neutral.bvh",
                                         "makehuman/rig/game_engine_male.bvh", "cmu/daz/02_05.bvh",
                                         "cmu/max/131_01.bvh",
                                         "/usr/share/assimp/models/BVH/Boxing_Toes.bvh"),
                         [](const auto& tested) {
                             std::string name = std::filesystem::path(tested.param).stem();
                             for (char& c : name)
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             return name;
                         });

/// Any two of its limbs are mirror images.
TEST(ShapeRolesOf, StarHasNoRoles) {
    RestSkeleton star;
    star.add("middle", -1, glm::dvec3(0));
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 way(std::cos(i), std::sin(i), 0.001 * i);
        int parent = 0;
        for (int part = 1; part <= 3; ++part)
            parent = star.add("b" + std::to_string(i) + "_" + std::to_string(part), parent,
                              double(part) * glm::normalize(way));
    }
    EXPECT_FALSE(recogniseJoints(star).known());
}

TEST(ShapeRolesOf, ObjectsHaveNoRoles) {
    RestSkeleton snake;
    for (int j = 0; j < 20; ++j) snake.add("b" + std::to_string(j), j - 1, glm::dvec3(0, 0, j));
    EXPECT_FALSE(recogniseJoints(snake).known());

    // A dog: its trunk is perpendicular to its legs.
    RestSkeleton dog;
    const int rump = dog.add("a", -1, glm::dvec3(0, 1, 0));
    const int chest = dog.add("b", rump, glm::dvec3(0, 1, 1));
    const int neck = dog.add("c", chest, glm::dvec3(0, 1.2, 1.2));
    dog.add("d", neck, glm::dvec3(0, 1.4, 1.4));
    for (const int base : {rump, chest})
        for (const double across : {0.2, -0.2}) {
            const double along = base == rump ? 0.0 : 1.0;
            const std::string name = std::to_string(base) + (across > 0.0 ? "l" : "r");
            const int upper = dog.add(name + "1", base, glm::dvec3(across, 0.9, along));
            const int lower = dog.add(name + "2", upper, glm::dvec3(across, 0.5, along));
            dog.add(name + "3", lower, glm::dvec3(across, 0.1, along));
        }
    EXPECT_FALSE(recogniseJoints(dog).known());
}

TEST(ShapeRolesOf, ReportNamesTheRoles) {
    const RestSkeleton body = nameless(importSkeleton(OSGSKIN_DATA "/thrower.bvh"));
    RetargetReport report;
    retarget(importMotion(OSGSKIN_DATA "/throw.bvh"), body, {}, &report);
    EXPECT_EQ(report.rigNames, kInferredFromGeometry);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("inferred from its shape"), std::string::npos)
        << report.notes[0];
    EXPECT_NE(report.text().find("names: rig inferred from the skeleton's shape, motion CMU"),
              std::string::npos);
}
