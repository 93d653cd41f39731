// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bodies of other proportions than those at hand, made of them.
#include "KnownBody.h"
#include "Ratios.h"
#include "Stretches.h"
#include "mesh/WeldedMesh.h"
#include "ratios/RatioFields.h"
#include "regions/Regions.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// The skin moved in along its normals.
KnownBody thinned(KnownBody body, double distance) {
    const WeldedMesh skin(body.mesh);
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
        body.mesh.positions[v] -= distance * skin.normals[skin.weldedOf[v]];
    return body;
}

/// Both forearms `factor` times as long; what is beyond an elbow moves with it.
KnownBody withForearms(const KnownBody& body, double factor) {
    KnownBody result = body;
    for (const std::string side : {"Left", "Right"}) {
        const auto centre = [&](const char* joint) {
            const int found = body.truth.find(side + joint);
            return body.truth.joints[static_cast<std::size_t>(found)].centre;
        };
        const glm::dvec3 elbow = centre("ForeArm");
        const glm::dvec3 bone = centre("Hand") - elbow;
        const auto moved = [&](const glm::dvec3& p) {
            if ((p.x > 0.0) != (elbow.x > 0.0) || std::abs(p.x) < std::abs(elbow.x) - 0.5) return p;
            const double along = glm::dot(p - elbow, bone) / glm::dot(bone, bone);
            return p + (factor - 1.0) * std::clamp(along, 0.0, 1.0) * bone;
        };
        result = result.mapped(moved);
    }
    return result;
}

/// Of the body with both arms raised.
std::vector<double> stretchesWithArmsUp(const KnownBody& body) {
    const glm::dvec3 z(0, 0, 1);
    const KnownBody up = body.posed({{"LeftArm", glm::angleAxis(glm::radians(100.0), z)},
                                     {"RightArm", glm::angleAxis(glm::radians(-100.0), z)}});
    return stretches(body.mesh, up.mesh);
}

/// Mean ratio of the left upper arm over its middle third.
double upperArmRigidity(const KnownBody& body) {
    const Binding binding = bind(body.mesh, body.truth);
    const std::size_t arm = jointCalled(binding, "LeftArm");
    const glm::dvec3 from = binding.joints[arm].centre;
    const glm::dvec3 way = binding.joints[jointCalled(binding, "LeftForeArm")].centre - from;
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        if (binding.regions[v] != arm) continue;
        const double along = glm::dot(body.mesh.positions[v] - from, way) / glm::dot(way, way);
        if (along < 1.0 / 3.0 || along > 2.0 / 3.0) continue;
        sum += static_cast<double>(ratiosOf(binding, v, arm).bend);
        count += 1.0;
    }
    return sum / count;
}

/// A square of triangles, two units wide, and the field that rises over it from the left.
struct Sheet {
    SkinMesh mesh;
    std::vector<double> field;

    template <typename Rise>
    explicit Sheet(const Rise& rise) {
        constexpr std::uint32_t kSide = 21;
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                mesh.positions.emplace_back(0.1 * x - 1.0, 0.1 * y - 1.0, 0.0);
                field.push_back(rise(mesh.positions.back()));
                if (x == 0 || y == 0) continue;
                const std::uint32_t v = y * kSide + x;
                for (const std::uint32_t corner :
                     {v - kSide - 1, v - kSide, v, v - kSide - 1, v, v - 1})
                    mesh.faceVertices.push_back(corner);
            }
        mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    }

    double shareAt(double x, double y) const {
        const auto v = static_cast<std::size_t>(std::lround(10.0 * (y + 1.0)) * 21 +
                                                std::lround(10.0 * (x + 1.0)));
        return gradientFactor(WeldedMesh(mesh), field)[v];
    }
};

} // namespace

TEST(UnseenBodies, ThinArmpitsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    for (const double millimetres : {0.0, 6.0, 8.0})
        EXPECT_LT(stretchesWithArmsUp(thinned(neutral, 0.01 * millimetres)).back(), 2.45)
            << millimetres << " mm thinner";
}

TEST(UnseenBodies, ThrowersArmpitsStretchLittle) {
    const std::vector<double> sorted = stretchesWithArmsUp(KnownBody::thrower());
    EXPECT_LT(sorted.back(), 2.15);
    EXPECT_LT(percentile999(sorted), 1.93);
}

TEST(UnseenBodies, LongForearmsLeaveUpperArmsRigid) {
    for (const double factor : {1.0, 1.3, 1.6})
        EXPECT_GT(upperArmRigidity(withForearms(KnownBody::thrower(), factor)), 0.965) << factor;
}

TEST(GradientFactor, IsOneWhereASlopeIsEven) {
    const Sheet even([](const glm::dvec3& p) { return 0.5 + 0.4 * p.x; });
    EXPECT_NEAR(even.shareAt(0.0, 0.0), 1.0, 1e-9);
    const Sheet flat([](const glm::dvec3&) { return 1.0; });
    EXPECT_EQ(flat.shareAt(0.0, 0.0), 1.0);
}

TEST(GradientFactor, SaysHowMuchSteeperASlopeIsThanAtLarge) {
    // Rises within two units at the lower edge, within one at the upper: half again as steep in
    // the mean, so a third steeper than that at the one, and not below 1 at the other.
    const Sheet fan([](const glm::dvec3& p) {
        const double width = 1.5 - 0.5 * p.y;
        return std::clamp(0.5 + p.x / width, 0.0, 1.0);
    });
    EXPECT_GT(fan.shareAt(0.0, 0.8), 1.2);
    EXPECT_LT(fan.shareAt(0.0, 0.8), 1.5);
    EXPECT_EQ(fan.shareAt(0.0, -0.8), 1.0);
    EXPECT_EQ(fan.shareAt(-0.9, 0.9), 1.0); // flat there
}

TEST(FacesLimb, IsTrueForATorsosSideBesideAHangingArm) {
    PlannedJoint arm;
    arm.centre = {2.0, 0.0, 0.0};
    arm.boneAxis = {0.0, -1.0, 0.0};
    arm.boneLength = 3.0;
    const double radius = 0.5;
    const glm::dvec3 outwards(1, 0, 0), inwards(-1, 0, 0);
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, outwards));
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, 0.5, 0.0}, outwards)) << "above the shoulder";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, inwards)) << "a very thick arm's";
    EXPECT_FALSE(facesLimb(arm, radius, {1.5, -1.0, 0.0}, outwards)) << "in the armpit";
    EXPECT_FALSE(facesLimb(arm, radius, {2.5, -1.0, 0.0}, outwards)) << "the arm's own";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, {0, 0, 1})) << "the chest";
}
