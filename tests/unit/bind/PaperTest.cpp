// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"
#include "ratios/PaperFields.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace osgSkin;

namespace {

BindOptions printed() {
    BindOptions options;
    options.method = BindOptions::Method::Paper;
    return options;
}

/// Eq. 5.
double hermite(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

struct Straight {
    SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({0.6, 3.0, 5.5}, 7.5);
};

/// Expects joint 1's bend and twist ratios to follow eq. 5 between these heights.
void expectBetween(const Straight& limb, const Binding& binding, const glm::dvec2& bend,
                   const glm::dvec2& twist) {
    expectSound(binding);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double y = limb.mesh.positions[v].y;
        const Influence ratios = ratiosOf(binding, v, 1);
        EXPECT_NEAR(ratios.bend, hermite((y - bend.x) / (bend.y - bend.x)), 1e-4) << "at " << y;
        EXPECT_NEAR(ratios.twist, hermite((y - twist.x) / (twist.y - twist.x)), 1e-4) << "at " << y;
        if (y <= bend.x) {
            EXPECT_EQ(ratios.bend, 0.0f) << "at " << y;
        }
        if (y >= bend.y) {
            EXPECT_EQ(ratios.bend, 1.0f) << "at " << y;
        }
    }
}

} // namespace

TEST(Paper, JointsWithoutARegionDoNotEndIt) {
    const Straight limb;
    BindOptions options = printed();
    options.joints["joint1"].skip = true;
    const Binding binding = bind(limb.mesh, limb.skeleton, options);
    std::size_t followed = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        if (ratiosOf(binding, v, 2).bend == 1.0f) ++followed;
    EXPECT_GT(followed, binding.vertexCount() / 10);
}

TEST(Paper, StraightLimbTakesEquation5BetweenItsBoundaries) {
    const Straight limb;
    BindOptions options = printed();
    options.joints["joint1"].bendUpper = -0.4;
    options.joints["joint1"].bendLower = 0.2;
    options.joints["joint1"].twistUpper = 0.1;
    options.joints["joint1"].twistLower = 0.9;
    expectBetween(limb, bind(limb.mesh, limb.skeleton, options), {2.0, 3.5}, {3.25, 5.25});
}

TEST(Paper, BendsOverThreeTenthsOfABoneAndTwistsOverAllOfItByDefault) {
    const Straight limb;
    const Binding binding = bind(limb.mesh, limb.skeleton, printed());
    expectSound(binding);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double y = limb.mesh.positions[v].y;
        const Influence ratios = ratiosOf(binding, v, 1);
        const double bend = hermite((y - 2.28) / 1.47); // 0.3 of 2.4 above, and of 2.5 below
        EXPECT_NEAR(ratios.bend, bend, 1e-4) << "at " << y;
        EXPECT_NEAR(ratios.twist, std::min(bend, hermite((y - 3.0) / 2.5)), 1e-4) << "at " << y;
    }
}

TEST(Paper, ReportsTheBoundariesItUsed) {
    const Straight limb;
    BindReport report;
    bind(limb.mesh, limb.skeleton, printed(), &report);
    ASSERT_EQ(report.boundaries.size(), 3u);
    const BindReport::Boundaries& joint = report.boundaries[1];
    EXPECT_NEAR(joint.bendUpper.value(), -0.72 / 2.5, 1e-12); // 0.3 of the bone above, in units of
                                                              // the joint's own bone
    EXPECT_NEAR(joint.bendLower.value(), 0.3, 1e-12);
    EXPECT_NEAR(joint.twistUpper.value(), 0.0, 1e-12);
    EXPECT_NEAR(joint.twistLower.value(), 1.0, 1e-12);
    EXPECT_FALSE(report.boundaries[0].bendUpper.has_value()) << "the root has no region to bend";
}

TEST(Paper, SmoothReportsOnlyTheBoundariesThatThereAre) {
    const Straight limb;
    BindReport report;
    const Binding binding = bind(limb.mesh, limb.skeleton, {}, &report);
    const BindReport::Boundaries& joint = report.boundaries.at(1);
    EXPECT_FALSE(joint.bendUpper || joint.bendLower);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        if (joint.twistUpper && ratiosOf(binding, v, 1).bend == 1.0f &&
            ratiosOf(binding, v, 2).bend == 0.0f && ratiosOf(binding, v, 2).twist == 0.0f) {
            const double along = (limb.mesh.positions[v].y - 3.0) / 2.5;
            const double t = (along - *joint.twistUpper) / (*joint.twistLower - *joint.twistUpper);
            EXPECT_NEAR(ratiosOf(binding, v, 1).twist, hermite(t), 1e-4) << "vertex " << v;
        }
    BindOptions options;
    options.joints["joint1"].bendUpper = -0.25;
    bind(limb.mesh, limb.skeleton, options, &report);
    EXPECT_EQ(report.boundaries.at(1).bendUpper, -0.25);
}

TEST(Paper, OneBoundaryBeyondTheOthersDefaultPushesItOn) {
    const Straight limb;
    BindOptions options = printed();
    options.joints["joint1"].bendUpper = 0.4; // the lower one's default is 0.3
    options.joints["joint1"].twistUpper = 0.0;
    const Binding binding = bind(limb.mesh, limb.skeleton, options);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double y = limb.mesh.positions[v].y;
        EXPECT_NEAR(ratiosOf(binding, v, 1).bend, hermite((y - 4.0) / 1.47), 1e-4) << "at " << y;
    }
}

TEST(Paper, BentLimbTakesTheShortestSegmentAcrossTheWedge) {
    // The same cylinder over a chain that bends by 40 degrees at joint 1.
    SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({0.6, 4.0}, 7.0);
    const double turn = 40.0 * 3.14159265358979 / 180.0;
    const glm::dvec3 bone(0.0, std::cos(turn), std::sin(turn));
    skeleton.joints.back().tip = glm::dvec3(0, 4, 0) + 4.0 * bone;
    BindOptions options = printed();
    options.joints["joint1"].bendUpper = -0.3;
    options.joints["joint1"].bendLower = 0.3;
    const Binding binding = bind(mesh, skeleton, options);
    expectSound(binding);
    const glm::dvec3 upper(0, 2.8, 0), lower = glm::dvec3(0, 4, 0) + 1.2 * bone;
    std::size_t between = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        const double below = p.y - upper.y, above = glm::dot(lower - p, bone);
        const float ratio = ratiosOf(binding, v, 1).bend;
        if (below <= 0.0 || above <= 0.0) {
            EXPECT_EQ(ratio, above <= 0.0 ? 1.0f : 0.0f) << "vertex " << v;
            continue;
        }
        // The direction of the shortest crossing in the plane of the two normals.
        double shortest = INFINITY, share = 0.0;
        for (double angle = turn - 1.57; angle < 1.57; angle += 1e-4) {
            const double h = below / std::cos(angle);
            const double rest = above / std::cos(angle - turn);
            if (h + rest >= shortest) continue;
            shortest = h + rest;
            share = h / shortest;
        }
        EXPECT_NEAR(ratio, hermite(share), 1e-3) << "vertex " << v;
        ++between;
    }
    EXPECT_GT(between, 100u);
}

TEST(Paper, BindsArmsBesideATrunk) {
    const Binding binding = bind(shapes::hangingArms(), shapes::hangingArmsSkeleton(), printed());
    expectSound(binding);
}

TEST(Paper, ZeroLengthAndSkippedJointsTurnWhatTheirChildrenTurn) {
    Straight limb;
    limb.skeleton = shapes::chainAlongY({0.6, 3.0, 3.0, 5.5}, 7.5);
    BindOptions options = printed();
    options.joints["joint3"].skip = true;
    const Binding binding = bind(limb.mesh, limb.skeleton, options);
    expectSound(binding);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        if (limb.mesh.positions[v].y > 7.0) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << "vertex " << v;
        }
}

TEST(Paper, BindsABody) {
    const auto rig = shared::makehuman() / "rig" / "joints_cmu_mb_male.json";
    if (!std::filesystem::exists(rig)) GTEST_SKIP() << "needs " << rig;
    const SkinMesh mesh = shared::readObj(shared::makehuman() / "body" / "body4k_male.obj");
    const RestSkeleton skeleton = shared::readJoints(rig);
    BindReport report;
    const Binding binding = bind(mesh, skeleton, printed(), &report);
    expectSound(binding);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_LT(report.influencesPerVertex, 2.1) << report.text();
}

using osgSkin::philoShare;

namespace {

/// A point between two planes: its distance below the upper and above the lower one, and their unit
/// normals, both pointing to the lower side.
struct Wedge {
    double a, b;
    glm::dvec3 upper, lower;

    /// Length of the segment through the point along `d`; infinite if it does not meet both planes.
    double length(const glm::dvec3& d) const {
        const double down = glm::dot(d, upper), on = glm::dot(d, lower);
        return down > 0.0 && on > 0.0 ? a / down + b / on : INFINITY;
    }
    double share(const glm::dvec3& d) const { return a / glm::dot(d, upper) / length(d); }
    double angle() const {
        return std::atan2(glm::length(glm::cross(upper, lower)), glm::dot(upper, lower));
    }
};

/// The direction of the shortest segment by search over all directions.
glm::dvec3 shortest(const Wedge& wedge) {
    glm::dvec3 best = glm::normalize(wedge.upper + wedge.lower);
    for (double step = 0.5; step > 1e-9; step *= 0.7)
        for (bool better = true; better;) {
            better = false;
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    for (int z = -1; z <= 1; ++z) {
                        const glm::dvec3 d = glm::normalize(best + step * glm::dvec3(x, y, z));
                        if (wedge.length(d) < wedge.length(best)) best = d, better = true;
                    }
        }
    return best;
}

class Philo : public testing::Test {
protected:
    std::mt19937 random{7};
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    }
};

} // namespace

TEST_F(Philo, SegmentIsTheShortestOfAllThroughThePoint) {
    for (int i = 0; i < 300; ++i) {
        const Wedge wedge{std::exp(between(-4, 4)), std::exp(between(-4, 4)), direction(),
                          direction()};
        if (wedge.angle() > 2.9) continue; // nearly a half space: the search itself is inaccurate
        EXPECT_NEAR(philoShare(wedge.a, wedge.b, wedge.angle()), wedge.share(shortest(wedge)), 1e-5)
            << wedge.a << ' ' << wedge.b << ' ' << wedge.angle();
    }
}

TEST_F(Philo, BetweenParallelPlanesItIsThePerpendicular) {
    EXPECT_EQ(philoShare(1.0, 3.0, 0.0), 0.25);
    for (const double angle : {1e-12, 1e-9, 1e-7, 1e-5})
        EXPECT_NEAR(philoShare(1.0, 3.0, angle), 0.25, 1e-9) << angle;
}

TEST_F(Philo, InTheMiddleItIsHalf) {
    for (double angle = 0.0; angle < 3.1; angle += 0.1)
        EXPECT_NEAR(philoShare(2.0, 2.0, angle), 0.5, 1e-12) << angle;
}

TEST_F(Philo, ExchangingThePlanesTurnsItRound) {
    for (int i = 0; i < 1000; ++i) {
        const double a = between(0, 5), b = between(0, 5), angle = between(0, 3.1);
        EXPECT_NEAR(philoShare(a, b, angle), 1.0 - philoShare(b, a, angle), 1e-10);
    }
}

TEST_F(Philo, UnitDoesNotMatter) {
    for (const double unit : {1e-9, 1e-3, 1e3, 1e9})
        EXPECT_NEAR(philoShare(unit, 2.0 * unit, 0.7), philoShare(1.0, 2.0, 0.7), 1e-12) << unit;
}

TEST_F(Philo, GrowsFromTheUpperPlaneToTheLower) {
    for (const double angle : {0.0, 0.3, 1.0, 1.5707963, 2.5, 3.1}) {
        EXPECT_EQ(philoShare(0.0, 1.0, angle), 0.0);
        EXPECT_EQ(philoShare(1.0, 0.0, angle), 1.0);
        double last = 0.0;
        for (double s = 0.001; s < 1.0; s += 0.001) {
            const double here = philoShare(s, 1.0 - s, angle);
            EXPECT_GT(here, last) << angle << ' ' << s;
            last = here;
        }
        EXPECT_LT(last, 1.0);
    }
}

TEST_F(Philo, ExtremesStayInRange) {
    for (const double a : {1e-300, 1e-30, 1e-12, 1.0, 1e12, 1e30})
        for (const double b : {1e-300, 1e-30, 1e-12, 1.0, 1e12, 1e30})
            for (const double angle :
                 {0.0, 1e-15, 1e-8, 1.5707963267948966, 3.1415, 3.14159265, 3.141592653589793}) {
                const double share = philoShare(a, b, angle);
                EXPECT_GE(share, 0.0) << a << ' ' << b << ' ' << angle;
                EXPECT_LE(share, 1.0) << a << ' ' << b << ' ' << angle;
            }
}

namespace {

/// A long thin arm along +y: shoulder at 1, elbow at 7, wrist at 13, fingers from 14 to 15.5.
const SkinMesh& arm() {
    static const SkinMesh mesh = shapes::cylinder(16.0, 12);
    return mesh;
}

RestSkeleton armSkeleton() {
    RestSkeleton skeleton = shapes::chainAlongY({0.3, 1.1, 7.1, 13.1, 14.1}, 15.5);
    const char* names[] = {"Chest", "Arm", "ForeArm", "Hand", "Finger"};
    for (std::size_t j = 0; j < 5; ++j) skeleton.joints[j].name = names[j];
    return skeleton;
}

float twistAt(const Binding& binding, std::size_t joint, double height) {
    for (std::size_t v = 0; v < arm().positions.size(); ++v)
        if (std::abs(arm().positions[v].y - height) < 1e-9)
            return ratiosOf(binding, v, joint).twist;
    ADD_FAILURE() << "no ring at " << height;
    return -1.0f;
}

} // namespace

TEST(Twist, OfAHandBuildsUpAlongTheForearm) {
    const Binding binding = bind(arm(), armSkeleton());
    expectSound(binding);
    EXPECT_EQ(twistAt(binding, 3, 5.0), 0.0f); // upper arm
    EXPECT_NEAR(twistAt(binding, 3, 10.0), 0.4, 0.12);
    EXPECT_GT(twistAt(binding, 3, 12.5), 0.75f);
    EXPECT_EQ(twistAt(binding, 3, 15.0), 1.0f);
    for (double height = 1.0; height < 16.0; height += 0.25)
        EXPECT_LT(twistAt(binding, 3, height) - twistAt(binding, 3, height - 0.25), 0.12f)
            << "at " << height;
}

/// Skin is sheared equally everywhere: a hand's twist grows faster along thinner parts of the
/// forearm.
TEST(Twist, OfAHandGrowsFasterWhereTheForearmIsThinner) {
    SkinMesh tapered = arm();
    for (glm::dvec3& p : tapered.positions) {
        const double radius = 1.0 - 0.5 * std::clamp((p.y - 7.0) / 6.0, 0.0, 1.0);
        p.x *= radius;
        p.z *= radius;
    }
    const auto ofRates = [](const Binding& binding) {
        return (twistAt(binding, 3, 12.0) - twistAt(binding, 3, 11.0)) /
               (twistAt(binding, 3, 10.5) - twistAt(binding, 3, 9.5));
    };
    const float straight = ofRates(bind(arm(), armSkeleton()));
    // Rates are inversely proportional to the radii there.
    EXPECT_NEAR(ofRates(bind(tapered, armSkeleton())) / straight, 0.75 / 0.625, 0.06);
}

TEST(Twist, OfALimbBuildsUpTowardsTheChild) {
    const Binding binding = bind(arm(), armSkeleton());
    EXPECT_LT(twistAt(binding, 1, 2.5), 0.3f); // the bend is already complete here
    EXPECT_NEAR(twistAt(binding, 1, 4.0), 0.5, 0.15);
    EXPECT_GT(twistAt(binding, 1, 6.0), 0.85f);
    EXPECT_EQ(twistAt(binding, 1, 8.0), 1.0f);
}

TEST(Twist, PoleFollowsTheOption) {
    RestSkeleton skeleton = armSkeleton();
    skeleton.joints[3].centre.x = 0.3; // so that the bones above and below differ
    const glm::dvec3 above = glm::normalize(skeleton.joints[3].centre - skeleton.joints[2].centre);
    const glm::dvec3 below = glm::normalize(skeleton.joints[4].centre - skeleton.joints[3].centre);
    struct Case {
        JointBindOptions::Pole pole;
        glm::dvec3 axis;
    };
    for (const Case& c : {Case{JointBindOptions::Pole::Automatic, above},
                          Case{JointBindOptions::Pole::Parent, above},
                          Case{JointBindOptions::Pole::Child, below}}) {
        BindOptions options;
        options.joints["Hand"].twistAxis = c.pole;
        const Binding binding = bind(arm(), skeleton, options);
        EXPECT_LT(glm::distance(binding.joints[3].twistAxis, c.axis), 1e-12);
        EXPECT_LT(glm::distance(binding.joints[3].boneAxis, below), 1e-12);
    }
    const Binding automatic = bind(arm(), skeleton);
    EXPECT_LT(glm::distance(automatic.joints[2].twistAxis, above), 1e-12);
}

TEST(Twist, AuthorsBoundariesAreKept) {
    BindOptions options;
    options.joints["Hand"].twistUpper = -0.5;
    options.joints["Hand"].twistLower = -0.25;
    const Binding binding = bind(arm(), armSkeleton(), options);
    expectSound(binding);
    EXPECT_EQ(twistAt(binding, 3, 10.0), 0.0f);
    EXPECT_NEAR(twistAt(binding, 3, 11.0), 0.7, 0.15);
    EXPECT_EQ(twistAt(binding, 3, 11.75), 1.0f);
}
