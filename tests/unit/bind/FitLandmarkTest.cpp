// SPDX-License-Identifier: GPL-3.0-or-later
//
// An author's landmarks override the fit.
#include "JointSpellings.h"
#include "KnownBody.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/FitSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

using namespace osgSkin;

namespace {

glm::dvec3 at(const RestSkeleton& skeleton, const std::string& name) {
    return skeleton.joints.at(static_cast<std::size_t>(skeleton.find(name))).centre;
}

/// The thrower with its arms against its thighs.
KnownBody hangingArms() {
    const auto turn = [](double degrees) {
        return glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 0, 1));
    };
    return KnownBody::thrower().posed({{"LeftArm", turn(-50.0)}, {"RightArm", turn(50.0)}});
}

} // namespace

TEST(FitLandmark, MovesItsJointAndTheNeighbours) {
    const KnownBody body = KnownBody::thrower();
    const RestSkeleton plain = fitSkeleton(body.mesh);
    FitOptions options;
    // A wrist 3 cm farther up the arm.
    const glm::dvec3 up = glm::normalize(at(plain, "LeftForeArm") - at(plain, "LeftHand"));
    options.landmarks["LeftHand"] = at(plain, "LeftHand") + 0.03 * up;
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    EXPECT_LT(glm::distance(at(fitted, "LeftHand"), options.landmarks["LeftHand"]), 1e-9);
    // CGAL's skeletons differ from version to version: neighbours move by a tenth of it at least.
    EXPECT_GT(glm::distance(at(fitted, "LeftFingerBase"), at(plain, "LeftFingerBase")), 0.003);
    EXPECT_GT(glm::distance(at(fitted, "LeftForeArm"), at(plain, "LeftForeArm")), 0.003);
    EXPECT_LT(glm::distance(at(fitted, "LeftLeg"), at(plain, "LeftLeg")), 1e-9);
    // The figure is symmetric: so is its other wrist.
    EXPECT_LT(glm::distance(at(fitted, "RightHand"),
                            options.landmarks["LeftHand"] * glm::dvec3(-1, 1, 1)),
              0.01);
    for (const FitReport::Joint& joint : report.joints)
        EXPECT_EQ(joint.how == "landmark", joint.name == "LeftHand") << joint.name;
}

TEST(FitLandmark, DeterminesTheFacing) {
    const KnownBody body = KnownBody::thrower();
    FitOptions options;
    options.landmarks["LeftHand"] = at(body.truth, "RightHand"); // its back is towards us
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    EXPECT_EQ(report.facing, "from the landmarks");
    EXPECT_LT(at(fitted, "LeftUpLeg").x, 0.0);
    EXPECT_GT(at(fitted, "RightArm").x, 0.0);
}

TEST(FitLandmark, AllowsHangingArms) {
    const KnownBody body = hangingArms();
    EXPECT_THROW(fitSkeleton(body.mesh), Error);
    FitOptions options;
    for (const char* name : {"LeftArm", "LeftForeArm", "LeftHand"})
        options.landmarks[name] = at(body.truth, name);
    const FitErrors errors = fitErrors(fitSkeleton(body.mesh, options), body);
    EXPECT_EQ(errors.inside, 31u);
    EXPECT_LT(errors.mean, 0.02) << errors.worst << " " << errors.worstJoint;
}

TEST(FitLandmark, AllowsLegsInARobe) {
    // A person made of cubes of 0.1: a robe down to y = -1, arms out at y = 0.6, a head up to 1.2.
    const auto filled = [](int x, int y, int z) {
        const int aside = x < 0 ? -x - 1 : x;
        if (z < -1 || z > 0 || y < -10 || y >= 12) return false;
        if (y >= 8) return aside < 1;
        return aside < 3 || ((y == 6 || y == 7) && aside < 10);
    };
    const KnownBody body{shapes::voxelSurface(filled, 14, 0.1), {}};
    FitOptions options;
    EXPECT_THROW(fitSkeleton(body.mesh, options), Error);
    options.landmarks = {{"LeftUpLeg", {0.15, 0.1, 0.0}},
                         {"LeftFoot", {0.2, -0.9, 0.0}},
                         {"RightUpLeg", {-0.15, 0.1, 0.0}},
                         {"RightFoot", {-0.2, -0.9, 0.0}}};
    const RestSkeleton fitted = fitSkeleton(body.mesh, options);
    EXPECT_EQ(fitErrors(fitted, body).inside, 31u);
    for (const auto& [name, centre] : options.landmarks)
        EXPECT_LT(glm::distance(at(fitted, name), centre), 1e-9) << name;
    EXPECT_NEAR(at(fitted, "LeftLeg").y, -0.4, 0.05);
    EXPECT_GT(at(fitted, "LeftHand").x, 0.6);
}

TEST(FitLandmark, OnTheSkinIsMovedInside) {
    const KnownBody body = KnownBody::thrower();
    FitOptions options;
    options.landmarks["Head"] = at(body.truth, "Head") + glm::dvec3(0.0, 0.0, 0.12);
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    EXPECT_EQ(fitErrors(fitted, body).inside, 31u);
    ASSERT_EQ(report.notes.size(), 1u) << report.text();
    EXPECT_NE(report.notes[0].find("landmark Head"), std::string::npos);
}

TEST(FitLandmarkNames, AreRecognisedInEveryConvention) {
    const std::map<std::string, std::string> ours{
        {"Hips", "Hips"},        {"Head", "Head"},   {"UpperLeg", "UpLeg"},  {"LowerLeg", "Leg"},
        {"Foot", "Foot"},        {"Toe", "ToeBase"}, {"Collar", "Shoulder"}, {"UpperArm", "Arm"},
        {"LowerArm", "ForeArm"}, {"Hand", "Hand"}};
    for (const test::Dialect& dialect : test::dialects())
        for (const test::SideStyle& side : test::sideStyles())
            for (const std::string prefix : {"", "mixamorig_", "DEF-"}) {
                std::vector<std::string> names;
                std::map<std::string, std::string> expected;
                for (const auto& [role, own] : ours)
                    for (const std::string sideName : {"Left", "Right"}) {
                        const bool sided = role != "Hips" && role != "Head";
                        if (dialect.names.at(role) == "root") continue; // the tree determines it
                        names.push_back(test::spelled(dialect, (sided ? sideName : "") + role, side,
                                                      prefix, "", 0));
                        expected[names.back()] = (sided ? sideName : "") + own;
                        if (!sided) break;
                    }
                EXPECT_EQ(fittedNamesOf(names), expected)
                    << dialect.name << ", side " << side.text() << ", " << prefix;
            }
    EXPECT_EQ(fittedNamesOf({"hand.L"}).at("hand.L"), "LeftHand"); // by itself
    EXPECT_TRUE(fittedNamesOf({"Nose", "leg.L", "hand_ik.L", "spine_02"}).empty());
}
