// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(Paper, SkippedJointDoesNotEndTheChain) {
    const Straight limb;
    BindOptions options = printed();
    options.joints["joint1"].skip = true;
    const Binding binding = bind(limb.mesh, limb.skeleton, options);
    std::size_t followed = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        if (ratiosOf(binding, v, 2).bend == 1.0f) ++followed;
    EXPECT_GT(followed, binding.vertexCount() / 10);
}

TEST(Paper, StraightLimbFollowsEquation5) {
    const Straight limb;
    BindOptions options = printed();
    options.joints["joint1"].bendUpper = -0.4;
    options.joints["joint1"].bendLower = 0.2;
    options.joints["joint1"].twistUpper = 0.1;
    options.joints["joint1"].twistLower = 0.9;
    expectBetween(limb, bind(limb.mesh, limb.skeleton, options), {2.0, 3.5}, {3.25, 5.25});
}

TEST(Paper, DefaultBoundaries) {
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

TEST(Paper, SmoothMethodReportsOnlyBoundariesInUse) {
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

TEST(Paper, BoundaryPastTheOthersDefaultMovesIt) {
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

TEST(Paper, ZeroLengthAndSkippedJointsMoveTheirChildrensSkin) {
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
