// SPDX-License-Identifier: GPL-3.0-or-later
#include "RiggerFigures.h"
#include "DemandingPoses.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

namespace {

using namespace quality;
using osgSkin::RestSkeleton;

/// An arm along x that is bent by 30 degrees at rest, and a leg that hangs straight down.
RestSkeleton limbs() {
    RestSkeleton rig;
    rig.add("Hips", -1, glm::dvec3(0, 8, 0));
    rig.add("LeftArm", 0, glm::dvec3(1, 8, 0));
    rig.add("LeftForeArm", 1, glm::dvec3(3, 8, 0));
    const double angle = glm::radians(30.0);
    rig.add("LeftHand", 2,
            glm::dvec3(3, 8, 0) + 2.0 * glm::dvec3(std::cos(angle), 0, std::sin(angle)));
    rig.add("LeftUpLeg", 0, glm::dvec3(0, 8, 0));
    rig.add("LeftLeg", 4, glm::dvec3(0, 4, 0));
    rig.add("LeftFoot", 5, glm::dvec3(0, 0, 0));
    return rig;
}

glm::dvec3 placed(const RestSkeleton& rig, const BodyPose& pose, const char* joint) {
    const auto j = static_cast<std::size_t>(rig.find(joint));
    return glm::dvec3(pose.skinning()[j] * glm::dvec4(rig.joints[j].centre, 1.0));
}

double angleAt(const RestSkeleton& rig, const BodyPose& pose, const char* upper, const char* joint,
               const char* end) {
    const glm::dvec3 a = glm::normalize(placed(rig, pose, joint) - placed(rig, pose, upper));
    const glm::dvec3 b = glm::normalize(placed(rig, pose, end) - placed(rig, pose, joint));
    return glm::degrees(std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)));
}

constexpr int kSides = 16, kRings = 33;

/// A leg of radius 1 around the joints of limbs(), painted: rigid on both sides of the knee.
PaintedBody leg() {
    PaintedBody body;
    body.name = "leg";
    body.rig = limbs();
    const auto thigh = static_cast<std::uint32_t>(body.rig.find("LeftUpLeg"));
    const auto shin = static_cast<std::uint32_t>(body.rig.find("LeftLeg"));
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const double angle = 2.0 * glm::pi<double>() * side / kSides;
            const double height = 8.0 * ring / (kRings - 1);
            body.mesh.positions.emplace_back(std::cos(angle), height, std::sin(angle));
            body.painted.push_back({{height < 4.0 ? shin : thigh, 1.0}});
            if (ring == 0) continue;
            const auto at = [&](int r, int s) {
                return static_cast<std::uint32_t>(r * kSides + s % kSides);
            };
            for (const std::uint32_t corner :
                 {at(ring - 1, side), at(ring, side), at(ring, side + 1), at(ring - 1, side + 1)})
                body.mesh.faceVertices.push_back(corner);
            body.mesh.faceSizes.push_back(4);
        }
    return body;
}

/// The lowest ring's vertices follow another joint than the painted weights give.
PaintedBody wrongAtTheFoot(std::uint32_t joint) {
    PaintedBody body = leg();
    for (std::size_t v = 0; v < kSides; ++v) body.painted[v] = {{joint, 1.0}};
    return body;
}

TEST(BodyPose, FlexSetsTheAngleBetweenTwoBones) {
    const RestSkeleton rig = limbs();
    for (const double flexion : {0.0, 30.0, 90.0, 140.0}) {
        const BodyPose pose = BodyPose(rig).flex("LeftForeArm", flexion).flex("LeftLeg", flexion);
        EXPECT_NEAR(angleAt(rig, pose, "LeftArm", "LeftForeArm", "LeftHand"), flexion, 1e-6);
        EXPECT_NEAR(angleAt(rig, pose, "LeftUpLeg", "LeftLeg", "LeftFoot"), flexion, 1e-6);
    }
    // Heels move back.
    const BodyPose pose = BodyPose(rig).flex("LeftLeg", 90.0);
    EXPECT_NEAR(placed(rig, pose, "LeftFoot").z, -4.0, 1e-9);
}

TEST(BodyPose, AimIsIndependentOfParentRotations) {
    const RestSkeleton rig = limbs();
    BodyPose pose(rig);
    pose.rotate("Hips", {0, 1, 0}, 70.0).rotate("LeftArm", {1, 0, 0}, 20.0);
    pose.aim("LeftArm", {0, 2, 0}, 35.0);
    const glm::dvec3 way = placed(rig, pose, "LeftForeArm") - placed(rig, pose, "LeftArm");
    EXPECT_LT(glm::length(way - glm::dvec3(0, 2, 0)), 1e-9);
    pose.aim("LeftForeArm", {0, 0, -1}).twist("LeftForeArm", 50.0);
    const glm::dvec3 fore = placed(rig, pose, "LeftHand") - placed(rig, pose, "LeftForeArm");
    EXPECT_LT(glm::length(fore - glm::dvec3(0, 0, -2)), 1e-9);
}

TEST(BodyPose, IgnoresMissingJoints) {
    const RestSkeleton rig = limbs();
    const BodyPose pose = BodyPose(rig).rotate("Tail", {1, 0, 0}, 30.0).aim("RightArm", {0, 1, 0});
    for (const glm::dmat4& matrix : pose.skinning()) EXPECT_EQ(matrix, glm::dmat4(1.0));
}

TEST(DemandingPoses, HaveTwentyFourDifferentNames) {
    std::set<std::string> names;
    for (const DemandingPose& pose : demandingPoses(limbs())) names.insert(pose.pose.name);
    EXPECT_EQ(names.size(), 24u);
}

TEST(RiggerFigures, AreZeroForThePaintedSkinItself) {
    const std::vector<MeasuredSkin> skins{
        {"LBS", makeSubject(leg(), Ratios::Painted), Method::Linear},
        {"DQS", makeSubject(leg(), Ratios::Painted), Method::DualQuaternion},
        {"ours", makeSubject(leg(), Ratios::Painted), Method::Ours}};
    for (const RiggerFigures& figures : measureRigger(skins, {})) {
        SCOPED_TRACE(figures.skin);
        EXPECT_EQ(figures.inside, 0.0);
        EXPECT_EQ(figures.outside, 0.0);
        EXPECT_EQ(figures.worstCount, 0u);
        ASSERT_TRUE(figures.shinArea);
        EXPECT_NEAR(*figures.shinArea, 1.0, 1e-5);
        EXPECT_FALSE(figures.headWhole || figures.clavicleVolume || figures.fist);
    }
}

TEST(RiggerFigures, CountVerticesThatFollowTheWrongJoint) {
    const RestSkeleton rig = limbs();
    const auto hips = static_cast<std::uint32_t>(rig.find("Hips"));
    const auto arm = static_cast<std::uint32_t>(rig.find("LeftArm"));
    const double ring = 100.0 / kRings;
    for (const Method method : {Method::Linear, Method::Ours}) {
        const std::vector<MeasuredSkin> skins{
            {"painted", makeSubject(leg(), Ratios::Painted), method},
            {"hips", makeSubject(wrongAtTheFoot(hips), Ratios::Painted), method},
            {"arm", makeSubject(wrongAtTheFoot(arm), Ratios::Painted), method}};
        const std::vector<RiggerFigures> figures = measureRigger(skins, {});
        EXPECT_NEAR(figures[1].inside, ring, 1e-9);
        EXPECT_NEAR(figures[1].outside, 0.0, 1e-9);
        EXPECT_EQ(figures[1].worstCount, std::size_t(kSides));
        EXPECT_NEAR(figures[2].inside, ring, 1e-9);
    }
}

TEST(RiggerFigures, ArePrintedAndSaved) {
    const std::vector<MeasuredSkin> skins{
        {"LBS", makeSubject(leg(), Ratios::Painted), Method::Linear}};
    const std::vector<RiggerFigures> figures = measureRigger(skins, {});
    std::ostringstream table;
    printTable("leg", figures, table);
    EXPECT_NE(table.str().find("least section: shin                1.000"), std::string::npos)
        << table.str();
    EXPECT_EQ(toJson(figures.front())["skin"], "LBS");
    EXPECT_FALSE(toJson(figures.front()).contains("fist"));
}

} // namespace
