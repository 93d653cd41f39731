// SPDX-License-Identifier: GPL-3.0-or-later
//
// Skeletons fitted to bodies with known joints, and to bodies derived from them.
//
// Bodies and landmarks that no skeleton fits: refused with one line.
//
// An author's landmarks override the fit.
//
// Skeletons fitted to figures that are not one closed skin: dressed, in pieces, with large heads.
#include "JointSpellings.h"
#include "KnownBody.h"
#include "Shapes.h"
#include "WildBodies.h"
#include "fit/Proportions.h"

#include <osgSkin/Error>
#include <osgSkinBind/FitSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <ostream>
#include <random>

using namespace osgSkin;

namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

glm::dquat turn(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

/// All joints exist, are inside, and are far closer to their true positions than the 4 % that count
/// as good.
void expectFit(const KnownBody& body, const FitOptions& options = {}, double worst = 0.045) {
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    const FitErrors errors = fitErrors(fitted, body, options.up.z > 0.5);
    std::printf("mean %.1f %%, worst %.1f %% (%s), %zu inside, %.2f s\n", 100.0 * errors.mean,
                100.0 * errors.worst, errors.worstJoint.c_str(), errors.inside, report.seconds);
    EXPECT_EQ(errors.joints, 31u);
    EXPECT_EQ(errors.inside, 31u) << report.text();
    EXPECT_LT(errors.mean, 0.02) << report.text();
    EXPECT_LT(errors.worst, worst) << errors.worstJoint << "\n" << report.text();
}

struct Named {
    const char* mesh;
    const char* rig;
};

void PrintTo(const Named& named, std::ostream* out) {
    *out << named.mesh;
}

class FitShared : public testing::TestWithParam<Named> {};

/// The same figure as another file or another person may have it.
struct Variant {
    const char* name;
    KnownBody (*make)(const KnownBody& body);
};

void PrintTo(const Variant& variant, std::ostream* out) {
    *out << variant.name;
}

class FitVariant : public testing::TestWithParam<Variant> {};

KnownBody yawed(const KnownBody& body, double degrees) {
    return body.mapped(
        [&](const glm::dvec3& p) { return turn(degrees, kY) * p + glm::dvec3(3, -7, 11); });
}

/// Moves every vertex by a normally distributed distance, 2 mm for a person.
KnownBody rough(const KnownBody& body) {
    KnownBody result = body;
    std::mt19937 generator(1);
    std::normal_distribution<double> distance(0.0, 0.0012 * body.mesh.size());
    for (glm::dvec3& p : result.mesh.positions)
        for (int axis = 0; axis < 3; ++axis) p[axis] += distance(generator);
    return result;
}

KnownBody armsTurned(const KnownBody& body, double left, double right) {
    return body.posed({{"LeftArm", turn(left, kZ)}, {"RightArm", turn(-right, kZ)}});
}

const Variant kVariants[] = {
    {"as_it_is", [](const KnownBody& b) { return b; }},
    {"facing_left", [](const KnownBody& b) { return yawed(b, 90.0); }},
    {"facing_away", [](const KnownBody& b) { return yawed(b, 180.0); }},
    {"facing_anywhere", [](const KnownBody& b) { return yawed(b, -127.0); }},
    {"in_millimetres",
     [](const KnownBody& b) { return b.mapped([](const glm::dvec3& p) { return 1000.0 * p; }); }},
    {"stout",
     [](const KnownBody& b) {
         return b.mapped([](const glm::dvec3& p) { return p * glm::dvec3(1.15, 1.0, 1.1); });
     }},
    {"lean",
     [](const KnownBody& b) {
         return b.mapped([](const glm::dvec3& p) { return p * glm::dvec3(0.88, 1.0, 0.9); });
     }},
    {"long_legs",
     [](const KnownBody& b) {
         return b.mapped([](const glm::dvec3& p) {
             return glm::dvec3(p.x, p.y < 0.9 ? 1.12 * p.y : 1.008 + 0.88 * (p.y - 0.9), p.z);
         });
     }},
    {"rough", rough},
    {"split_at_every_edge",
     [](const KnownBody& b) {
         return KnownBody{shapes::exploded(b.mesh), b.truth};
     }},
    {"t_pose", [](const KnownBody& b) { return armsTurned(b, 40.0, 40.0); }},
    {"arms_lower", [](const KnownBody& b) { return armsTurned(b, -22.0, -22.0); }},
    {"one_arm_higher", [](const KnownBody& b) { return armsTurned(b, 25.0, 5.0); }},
    {"stride",
     [](const KnownBody& b) {
         return b.posed({{"LeftUpLeg", turn(-20.0, kX)},
                         {"RightUpLeg", turn(20.0, kX)},
                         {"LeftLeg", turn(15.0, kX)}});
     }},
};

} // namespace

TEST_P(FitShared, FindsTheJoints) {
    const KnownBody body = KnownBody::shared(GetParam().mesh, GetParam().rig);
    if (body.mesh.positions.empty())
        GTEST_SKIP() << "needs " << GetParam().mesh << " and its rig in " << OSGSKIN_SHARED_DATA;
    expectFit(body);
}

INSTANTIATE_TEST_SUITE_P(All, FitShared,
                         testing::Values(Named{"body4k_neutral", "cmu_mb_neutral"},
                                         Named{"body4k_male", "cmu_mb_male"},
                                         Named{"body_neutral", "cmu_mb_neutral"},
                                         Named{"body_male", "cmu_mb_male"},
                                         Named{"proxy_male1591_on_male_skin", "cmu_mb_male"}),
                         [](const auto& named) { return std::string(named.param.mesh); });

TEST_P(FitVariant, FindsTheJoints) {
    expectFit(GetParam().make(KnownBody::thrower()));
}

INSTANTIATE_TEST_SUITE_P(Thrower, FitVariant, testing::ValuesIn(kVariants),
                         [](const auto& variant) { return std::string(variant.param.name); });

TEST(Fit, FindsTheJointsWithZUp) {
    const KnownBody body =
        KnownBody::thrower().mapped([](const glm::dvec3& p) { return glm::dvec3(p.x, -p.z, p.y); });
    FitOptions options;
    options.up = kZ;
    expectFit(body, options);
}

TEST(Fit, HasTheTreeOfTheCmuFiles) {
    const KnownBody body = KnownBody::thrower();
    const RestSkeleton fitted = fitSkeleton(body.mesh);
    ASSERT_EQ(fitted.joints.size(), body.truth.joints.size());
    ASSERT_EQ(fittedJointNames().size(), fitted.joints.size());
    for (std::size_t j = 0; j < fitted.joints.size(); ++j) {
        const RestJoint& joint = fitted.joints[j];
        EXPECT_EQ(fittedJointNames()[j], joint.name);
        const int known = body.truth.find(joint.name);
        ASSERT_GE(known, 0) << joint.name;
        const int parent = body.truth.joints[static_cast<std::size_t>(known)].parent;
        if (joint.parent < 0)
            EXPECT_LT(parent, 0);
        else
            EXPECT_EQ(fitted.joints[static_cast<std::size_t>(joint.parent)].name,
                      body.truth.joints[static_cast<std::size_t>(parent)].name);
        EXPECT_EQ(joint.tip.has_value(), fitted.children(static_cast<int>(j)).empty())
            << joint.name;
    }
}

TEST(Fit, SaysHowEachJointWasFound) {
    FitReport report;
    fitSkeleton(KnownBody::thrower().mesh, {}, &report);
    ASSERT_EQ(report.joints.size(), 31u);
    for (const FitReport::Joint& joint : report.joints) EXPECT_FALSE(joint.how.empty());
    EXPECT_NEAR(report.height, 1.8, 0.001);
    EXPECT_EQ(report.facing, "from the feet");
    EXPECT_LT(report.symmetryError, 0.001);
    EXPECT_NE(report.text().find("joint LeftHand: at the thinnest section"), std::string::npos)
        << report.text();
}

TEST(Fit, IsTheSameEveryTime) {
    const KnownBody body = KnownBody::thrower();
    const RestSkeleton first = fitSkeleton(body.mesh), second = fitSkeleton(body.mesh);
    for (std::size_t j = 0; j < first.joints.size(); ++j)
        EXPECT_EQ(first.joints[j].centre, second.joints[j].centre) << first.joints[j].name;
}

TEST(Fit, IsSymmetricOnASymmetricBody) {
    const RestSkeleton fitted = fitSkeleton(KnownBody::thrower().mesh);
    for (const char* name : {"Hand", "ForeArm", "Leg", "ToeBase"}) {
        const glm::dvec3 left =
            fitted.joints[static_cast<std::size_t>(fitted.find("Left" + std::string(name)))].centre;
        const glm::dvec3 right =
            fitted.joints[static_cast<std::size_t>(fitted.find("Right" + std::string(name)))]
                .centre;
        EXPECT_LT(glm::distance(left, glm::dvec3(-right.x, right.y, right.z)), 0.01) << name;
    }
}

TEST(Fit, LeavesSmallShellsOut) {
    const KnownBody body = KnownBody::thrower();
    const SkinMesh button = shapes::moved(shapes::cylinder(), {0.0, 1.3, 0.3}, 0.01);
    FitReport report;
    const RestSkeleton with = fitSkeleton(shapes::joined(body.mesh, button), {}, &report);
    const RestSkeleton without = fitSkeleton(body.mesh);
    for (std::size_t j = 0; j < with.joints.size(); ++j)
        EXPECT_EQ(with.joints[j].centre, without.joints[j].centre);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_NE(report.notes[0].find("largest of 2 shells"), std::string::npos) << report.notes[0];
}

/// With many triangles, and far from the origin: the body has the larger area.
TEST(Fit, LeavesFineShellsOut) {
    const KnownBody body = KnownBody::thrower();
    const SkinMesh pole = shapes::moved(shapes::cylinder(8.0, 512), {0.0, 0.8, 0.3}, 0.1);
    const glm::dvec3 away(0.0, 0.0, 50.0);
    FitReport report;
    const RestSkeleton with =
        fitSkeleton(shapes::moved(shapes::joined(body.mesh, pole), away), {}, &report);
    const RestSkeleton without = fitSkeleton(shapes::moved(body.mesh, away));
    for (std::size_t j = 0; j < with.joints.size(); ++j)
        EXPECT_LT(glm::distance(with.joints[j].centre, without.joints[j].centre), 1e-9);
    EXPECT_NE(report.notes.at(0).find("largest of 2 shells"), std::string::npos) << report.notes[0];
}

namespace {

/// The faces whose corners `keep` all accepts.
SkinMesh cut(const SkinMesh& mesh, const std::function<bool(const glm::dvec3&)>& keep) {
    SkinMesh result;
    result.positions = mesh.positions;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        bool all = true;
        for (std::size_t i = corner; i < corner + size; ++i)
            all = all && keep(mesh.positions[mesh.faceVertices[i]]);
        if (all) {
            result.faceSizes.push_back(size);
            for (std::size_t i = corner; i < corner + size; ++i)
                result.faceVertices.push_back(mesh.faceVertices[i]);
        }
        corner += size;
    }
    return result;
}

struct BadBody {
    const char* name;
    SkinMesh (*make)(const SkinMesh& thrower);
    const char* expected; ///< part of the message
};

void PrintTo(const BadBody& bad, std::ostream* out) {
    *out << bad.name;
}

/// A person of boxes: trunk and head, legs, and arms at the given heights.
SkinMesh boxPerson(const std::vector<int>& arms) {
    const auto filled = [&](int x, int y, int z) {
        if (z < -1 || z > 0) return false;
        const int aside = x < 0 ? -x - 1 : x;
        if (y < 0) return y >= -10 && aside >= 1 && aside < 3;
        if (y < 8) {
            if (aside < 3) return true;
            for (const int arm : arms)
                if ((y == arm || y == arm + 1) && aside < 11) return true;
            return false;
        }
        return y < 12 && aside < 1;
    };
    return shapes::voxelSurface(filled, 14, 0.1);
}

const BadBody kBadBodies[] = {
    {"empty", [](const SkinMesh&) { return SkinMesh{}; }, "vert"},
    {"not_finite",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         bad.positions[7].y = std::numeric_limits<double>::quiet_NaN();
         return bad;
     },
     "finite"},
    {"of_no_area",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(1.0, 2.0, 3.0);
         return bad;
     },
     "area"},
    {"flat",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p.z = 0.0;
         return bad;
     },
     "flat"},
    {"cylinder", [](const SkinMesh&) { return shapes::cylinder(); }, "expected two legs"},
    {"lying_on_its_back",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(p.x, -p.z, p.y);
         return bad;
     },
     "expected an upright body"},
    {"upside_down",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(-p.x, -p.y, p.z);
         return bad;
     },
     "expected two legs"},
    {"without_legs",
     [](const SkinMesh& m) { return cut(m, [](const glm::dvec3& p) { return p.y > 0.95; }); },
     "expected"},
    {"with_one_leg",
     [](const SkinMesh& m) {
         return cut(m, [](const glm::dvec3& p) { return p.y > 0.75 || p.x < 0.0; });
     },
     "expected two legs"},
    {"with_one_arm",
     [](const SkinMesh& m) { return cut(m, [](const glm::dvec3& p) { return p.x < 0.24; }); },
     "expected two arms that stand off the trunk (a T or an A pose), found 1"},
    {"without_arms",
     [](const SkinMesh& m) {
         return cut(m, [](const glm::dvec3& p) { return std::abs(p.x) < 0.24; });
     },
     "expected two arms that stand off the trunk (a T or an A pose), found 0"},
    {"with_four_arms",
     [](const SkinMesh&) {
         return boxPerson({2, 6});
     },
     "expected two arms"},
};

class FitError : public testing::TestWithParam<BadBody> {};

/// The error of fitSkeleton() with these options on the thrower; empty if there is none.
std::string complaint(const SkinMesh& mesh, const FitOptions& options) {
    try {
        fitSkeleton(mesh, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_P(FitError, IsOneClearLine) {
    const std::string said = complaint(GetParam().make(KnownBody::thrower().mesh), {});
    EXPECT_NE(said.find(GetParam().expected), std::string::npos) << '"' << said << '"';
    EXPECT_EQ(said.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Body, FitError, testing::ValuesIn(kBadBodies),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(FitOptionsError, NamesTheLandmark) {
    const SkinMesh mesh = KnownBody::thrower().mesh;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    FitOptions options;
    options.landmarks["Nose"] = {0, 1.7, 0.1};
    EXPECT_NE(complaint(mesh, options).find("landmark Nose is no CMU joint"), std::string::npos);
    options.landmarks = {{"Head", {0.0, nan, 0.0}}};
    EXPECT_NE(complaint(mesh, options).find("landmark Head: expected finite"), std::string::npos);
    options.landmarks = {{"Head", {0.0, 2.5, 0.0}}};
    EXPECT_NE(complaint(mesh, options).find("landmark Head: expected a point inside the skin"),
              std::string::npos)
        << complaint(mesh, options);
    options.landmarks = {{"LeftLeg", {0.11, 1.2, 0.0}}}; // a knee above the hips
    EXPECT_NE(complaint(mesh, options).find("landmarks for LeftLeg and LeftFoot"),
              std::string::npos)
        << complaint(mesh, options);
}

TEST(FitOptionsError, WantsDirections) {
    const SkinMesh mesh = KnownBody::thrower().mesh;
    FitOptions options;
    options.up = glm::dvec3(0.0);
    EXPECT_NE(complaint(mesh, options).find("expected an up axis"), std::string::npos);
    options = {};
    options.facing = glm::dvec3(0.0);
    EXPECT_NE(complaint(mesh, options).find("expected a facing"), std::string::npos);
    options.facing = glm::dvec3(1.0, 0.0, 0.0); // the side of its left hand
    EXPECT_NE(complaint(mesh, options).find("must be perpendicular"), std::string::npos);
    options.facing = glm::dvec3(0.0, 0.0, -1.0);
    options.landmarks["LeftHand"] = {0.62, 1.07, 0.0115};
    EXPECT_NE(complaint(mesh, options).find("disagree"), std::string::npos);
}

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

TEST(FitLandmark, IsKeptAndItsNeighboursFollow) {
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

TEST(FitLandmark, TellsLeftFromRight) {
    const KnownBody body = KnownBody::thrower();
    FitOptions options;
    options.landmarks["LeftHand"] = at(body.truth, "RightHand"); // its back is towards us
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    EXPECT_EQ(report.facing, "from the landmarks");
    EXPECT_LT(at(fitted, "LeftUpLeg").x, 0.0);
    EXPECT_GT(at(fitted, "RightArm").x, 0.0);
}

TEST(FitLandmark, StandsInForArmsThatHang) {
    const KnownBody body = hangingArms();
    EXPECT_THROW(fitSkeleton(body.mesh), Error);
    FitOptions options;
    for (const char* name : {"LeftArm", "LeftForeArm", "LeftHand"})
        options.landmarks[name] = at(body.truth, name);
    const FitErrors errors = fitErrors(fitSkeleton(body.mesh, options), body);
    EXPECT_EQ(errors.inside, 31u);
    EXPECT_LT(errors.mean, 0.02) << errors.worst << " " << errors.worstJoint;
}

TEST(FitLandmark, StandsInForLegsInARobe) {
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

TEST(FitLandmarkNames, AreToldInEveryDialect) {
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

TEST(FitOptions, TakeOsgVectors) {
    FitOptions options;
    EXPECT_FALSE(options.facing);
    options.setUp(osg::Vec3d(0, 0, 2));
    options.setFacing(osg::Vec3d(0, -1, 0.5));
    options.setLandmark("LeftHand", osg::Vec3d(1, 2, 3));
    options.setLandmark("LeftHand", osg::Vec3d(4, 5, 6));
    EXPECT_EQ(options.up, glm::dvec3(0, 0, 2));
    EXPECT_EQ(options.facing, glm::dvec3(0, -1, 0.5));
    ASSERT_EQ(options.landmarks.size(), 1u);
    EXPECT_EQ(options.landmarks.at("LeftHand"), glm::dvec3(4, 5, 6));
}

namespace {

namespace part = osgSkin::proportions;

/// An upright figure with straight limbs and unusually long thighs, by this factor.
osgSkin::PlacedJoints figure(double thighs) {
    osgSkin::PlacedJoints placed;
    for (const double sign : {1.0, -1.0}) {
        const std::string side = sign > 0.0 ? "Left" : "Right";
        const double x = 0.1 * sign, knee = part::kHipHeight - thighs * part::kThigh;
        placed.addLandmark(side + "UpLeg", {x, part::kHipHeight, 0.0});
        placed.addLandmark(side + "Leg", {x, knee, 0.0});
        placed.addLandmark(side + "Foot", {x, knee - part::kShin, 0.0});
        const double elbow = x + sign * part::kUpperArm;
        placed.addLandmark(side + "Arm", {x, part::kShoulderHeight, 0.0});
        placed.addLandmark(side + "ForeArm", {elbow, part::kShoulderHeight, 0.0});
        placed.addLandmark(side + "Hand",
                           {elbow + sign * part::kForeArm, part::kShoulderHeight, 0.0});
    }
    return placed;
}

} // namespace

TEST(FitProportions, OddityIsTheMeanDeviation) {
    EXPECT_NEAR(osgSkin::oddity(figure(1.0)), 0.0, 1e-12);
    EXPECT_NEAR(osgSkin::oddity(figure(1.3)), std::log(1.3) / 6.0, 1e-12);
    EXPECT_NEAR(osgSkin::oddity(figure(1.0 / 1.3)), std::log(1.3) / 6.0, 1e-12);
    EXPECT_TRUE(std::isfinite(osgSkin::oddity(figure(0.0))));
}

namespace {

struct WildFigure {
    const char* name;
    KnownBody (*make)(const KnownBody& body);
    bool zUp = false;
};

void PrintTo(const WildFigure& figure, std::ostream* out) {
    *out << figure.name;
}

KnownBody tPose(const KnownBody& body) {
    const auto turn = [](double degrees) {
        return glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 0, 1));
    };
    return body.posed({{"LeftArm", turn(40.0)}, {"RightArm", turn(-40.0)}});
}

KnownBody standingOnZ(const KnownBody& body) {
    return body.mapped([](const glm::dvec3& p) { return 100.0 * glm::dvec3(p.x, -p.z, p.y); });
}

KnownBody facingBack(const KnownBody& body) {
    return body.mapped([](const glm::dvec3& p) { return glm::dvec3(-p.x, p.y, -p.z); });
}

const WildFigure kFigures[] = {
    {"clothed", wild::clothed},
    {"clothed_without_hidden_skin",
     [](const KnownBody& b) { return facingBack(wild::hollowClothed(b)); }},
    {"segmented_with_gaps_z_up_in_cm",
     [](const KnownBody& b) { return standingOnZ(wild::segmented(b, 0.04, true)); }, true},
    {"segmented_t_pose_flawed",
     [](const KnownBody& b) { return wild::flawed(wild::segmented(tPose(b), 0.0, true)); }},
    {"segmented_open", [](const KnownBody& b) { return wild::segmented(b, 0.0, false); }},
    {"mannequin", wild::mannequin},
    {"large_head_clothed",
     [](const KnownBody& b) { return wild::clothed(wild::cartoon(b, 2.0, 0.75)); }},
    {"very_thin_arms", [](const KnownBody& b) { return wild::thinArms(b, 0.25, 0.8); }},
};

class FitWild : public testing::TestWithParam<WildFigure> {};

} // namespace

TEST_P(FitWild, FindsTheJoints) {
    const KnownBody body = GetParam().make(KnownBody::thrower());
    FitOptions options;
    if (GetParam().zUp) options.up = {0, 0, 1};
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    const FitErrors errors = fitErrors(fitted, body, GetParam().zUp);
    std::printf("mean %.1f %%, worst %.1f %% (%s), %zu inside, %.2f s\n", 100.0 * errors.mean,
                100.0 * errors.worst, errors.worstJoint.c_str(), errors.inside, report.seconds);
    EXPECT_EQ(errors.joints, 31u);
    EXPECT_LT(errors.mean, 0.05) << report.text();
    EXPECT_LT(errors.worst, 0.12) << errors.worstJoint << "\n" << report.text();
}

INSTANTIATE_TEST_SUITE_P(Thrower, FitWild, testing::ValuesIn(kFigures),
                         [](const auto& figure) { return std::string(figure.param.name); });

TEST(FitWildError, NamesShellsAndLandmarks) {
    // Shells that are not a body: two boxes, one above the other.
    const SkinMesh box = shapes::cylinder();
    const SkinMesh two = shapes::joined(box, shapes::moved(box, {0.0, 8.5, 0.0}));
    try {
        fitSkeleton(two);
        FAIL();
    } catch (const Error& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find("union of 2 shells: one of"), std::string::npos) << said;
        EXPECT_NE(said.find("landmarks for LeftUpLeg"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
}
