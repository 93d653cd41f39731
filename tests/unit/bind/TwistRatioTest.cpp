// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

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

TEST(TwistRatio, OfAHandIncreasesAlongTheForearm) {
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
TEST(TwistRatio, OfAHandIncreasesFasterOnAThinnerForearm) {
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

TEST(TwistRatio, OfALimbIncreasesTowardsTheChild) {
    const Binding binding = bind(arm(), armSkeleton());
    EXPECT_LT(twistAt(binding, 1, 2.5), 0.3f); // the bend is already complete here
    EXPECT_NEAR(twistAt(binding, 1, 4.0), 0.5, 0.15);
    EXPECT_GT(twistAt(binding, 1, 6.0), 0.85f);
    EXPECT_EQ(twistAt(binding, 1, 8.0), 1.0f);
}

TEST(TwistRatio, PoleFollowsTheOption) {
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

TEST(TwistRatio, GivenBoundariesAreUsed) {
    BindOptions options;
    options.joints["Hand"].twistUpper = -0.5;
    options.joints["Hand"].twistLower = -0.25;
    const Binding binding = bind(arm(), armSkeleton(), options);
    expectSound(binding);
    EXPECT_EQ(twistAt(binding, 3, 10.0), 0.0f);
    EXPECT_NEAR(twistAt(binding, 3, 11.0), 0.7, 0.15);
    EXPECT_EQ(twistAt(binding, 3, 11.75), 1.0f);
}
