// SPDX-License-Identifier: GPL-3.0-or-later
//
// Skeletons fitted to bodies with known joints, and to bodies derived from them.
#include "KnownBody.h"
#include "Shapes.h"

#include <osgSkinBind/FitSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cstdio>
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

TEST(Fit, HasTheHierarchyOfCmuFiles) {
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

TEST(Fit, ReportsHowEachJointWasFound) {
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

TEST(Fit, IsDeterministic) {
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

TEST(Fit, IgnoresSmallShells) {
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
TEST(Fit, IgnoresSmallShellsWithManyTriangles) {
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

TEST(FitOptions, AcceptsOsgVectors) {
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
