// SPDX-License-Identifier: GPL-3.0-or-later
#include "PeakMemory.h"
#include "Ratios.h"
#include "Shapes.h"
#include "ratios/PackInfluences.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace osgSkin;

namespace {

/// Bend ratio of `joint` on the cylinder's ring at the given height; its vertices must agree.
float ringBend(const SkinMesh& mesh, const Binding& binding, std::size_t joint, double height) {
    float low = 2.0f, high = -1.0f;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (std::abs(mesh.positions[v].y - height) < 1e-9) {
            low = std::fmin(low, ratiosOf(binding, v, joint).bend);
            high = std::fmax(high, ratiosOf(binding, v, joint).bend);
        }
    EXPECT_LE(low, high) << "no ring at " << height;
    EXPECT_NEAR(low, high, 0.15) << "ring at " << height; // the fans' diagonals all lean one way
    return 0.5f * (low + high);
}

} // namespace

TEST(Ratios, RiseFromZeroToOneOverTheJoint) {
    const SkinMesh mesh = shapes::cylinder();
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0));
    expectSound(binding);
    EXPECT_EQ(ringBend(mesh, binding, 1, 0.0), 0.0f);
    EXPECT_EQ(ringBend(mesh, binding, 1, 2.0), 0.0f);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.0), 0.45, 0.1);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.25), 0.55, 0.1);
    EXPECT_EQ(ringBend(mesh, binding, 1, 6.25), 1.0f);
    EXPECT_EQ(ringBend(mesh, binding, 1, 8.0), 1.0f);
    float last = 0.0f;
    for (double height = 0.0; height <= 8.0; height += 0.25) {
        const float here = ringBend(mesh, binding, 1, height);
        EXPECT_GE(here, last - 1e-3f) << "at " << height;
        last = here;
    }
}

TEST(Ratios, DoNotDependOnUnitsOrPosition) {
    const SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    const Binding near = bind(mesh, skeleton);
    const glm::dvec3 offset(3000.0, -500.0, 200.0);
    for (RestJoint& joint : skeleton.joints) {
        joint.centre = 100.0 * joint.centre + offset;
        if (joint.tip) joint.tip = 100.0 * *joint.tip + offset;
    }
    const Binding far = bind(shapes::moved(mesh, offset, 100.0), skeleton);
    for (std::size_t v = 0; v < near.vertexCount(); ++v)
        ASSERT_NEAR(ratiosOf(near, v, 1).bend, ratiosOf(far, v, 1).bend, 1e-4) << "vertex " << v;
}

TEST(Ratios, SmoothingWidensTheBend) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    BindOptions narrow, wide;
    narrow.smoothing = 0.4;
    wide.smoothing = 1.2;
    const Binding tight = bind(mesh, skeleton, narrow);
    const Binding soft = bind(mesh, skeleton, wide);
    EXPECT_EQ(ringBend(mesh, tight, 1, 3.0), 0.0f);
    EXPECT_GT(ringBend(mesh, soft, 1, 3.0), 0.03f);
    EXPECT_EQ(ringBend(mesh, tight, 1, 5.25), 1.0f);
    EXPECT_LT(ringBend(mesh, soft, 1, 5.25), 0.97f);
}

TEST(Ratios, CutOffStiffensTheLimb) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    BindOptions none, much;
    none.smoothing = much.smoothing = 0.5;
    none.cutOff = 0.0;
    much.cutOff = 0.2;
    EXPECT_LT(ringBend(mesh, bind(mesh, skeleton, none), 1, 5.0), 0.97f);
    EXPECT_EQ(ringBend(mesh, bind(mesh, skeleton, much), 1, 5.0), 1.0f);
}

TEST(Ratios, GivenBoundariesAreUsed) {
    const SkinMesh mesh = shapes::cylinder();
    BindOptions options;
    options.joints["joint1"].bendUpper = -0.5; // the bone is 3 long: from 2.6 to 5.6
    options.joints["joint1"].bendLower = 0.5;
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.1), options);
    expectSound(binding);
    EXPECT_EQ(ringBend(mesh, binding, 1, 2.25), 0.0f);
    EXPECT_GT(ringBend(mesh, binding, 1, 3.25), 0.02f);
    EXPECT_LT(ringBend(mesh, binding, 1, 3.25), 0.25f);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.0), 0.45, 0.05);
    EXPECT_EQ(ringBend(mesh, binding, 1, 6.0), 1.0f);
}

TEST(Ratios, OneGivenBoundaryPlacesTheOther) {
    // The boundary that the author omits is as far behind his own as it would be behind the joint,
    // or at its default.
    const SkinMesh mesh = shapes::cylinder();
    for (const double upper : {-0.5, 0.2}) {
        BindOptions options;
        options.joints["joint1"].bendUpper = upper; // the bone is 3 long
        const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.1), options);
        expectSound(binding);
        const double begins = 4.1 + 3.0 * upper;
        EXPECT_LT(ringBend(mesh, binding, 1, std::floor(4.0 * begins - 1.0) / 4.0), 0.05f) << upper;
        EXPECT_EQ(ringBend(mesh, binding, 1, 6.5), 1.0f) << upper;
        EXPECT_LT(ringBend(mesh, binding, 1, 4.25), 0.9f) << upper;
    }
}

TEST(Ratios, SkippedJointMovesItsChildsSkin) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 3.1, 5.1}, 7.0);
    BindOptions options;
    options.joints["joint1"].skip = true;
    const Binding binding = bind(mesh, skeleton, options);
    expectSound(binding);
    const Binding plain = bind(mesh, skeleton);
    bool differs = false;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        ASSERT_NE(binding.regions[v], 1u);
        ASSERT_EQ(ratiosOf(binding, v, 1).bend, ratiosOf(binding, v, 2).bend) << "vertex " << v;
        differs = differs || ratiosOf(plain, v, 1).bend != ratiosOf(plain, v, 2).bend;
    }
    EXPECT_TRUE(differs);
}

TEST(Ratios, ZeroLengthJointMovesItsChildrensSkin) {
    const SkinMesh mesh = shapes::hangingArms();
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "chest", "", {0, 1, 0});
    shapes::addJoint(skeleton, "both", "chest", {0, 1, 0}); // its parent's position
    shapes::addJoint(skeleton, "left", "both", {1.6, -0.9, 0});
    shapes::addJoint(skeleton, "right", "both", {-1.6, -0.9, 0});
    const Binding binding = bind(mesh, skeleton);
    expectSound(binding);
    std::size_t turned = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const float most = std::fmax(ratiosOf(binding, v, 2).bend, ratiosOf(binding, v, 3).bend);
        ASSERT_EQ(ratiosOf(binding, v, 1).bend, most) << "vertex " << v;
        if (most == 1.0f) ++turned;
    }
    EXPECT_GT(turned, 100u);
}

TEST(Ratios, StayContinuousWhereManyJointsMeet) {
    // A ball with six joints close to its centre: more than four of them would rotate every vertex.
    const SkinMesh ball = shapes::voxelSurface(
        [](int x, int y, int z) {
            return (x + .5) * (x + .5) + (y + .5) * (y + .5) + (z + .5) * (z + .5) < 100.0;
        },
        12, 0.1);
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "middle", "", {0.02, 0.01, 0.03});
    const glm::dvec3 ways[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const glm::dvec3& way : ways)
        shapes::addJoint(skeleton, "joint" + std::to_string(skeleton.joints.size()), "middle",
                         0.3 * way);
    BindOptions options;
    options.smoothing = 2.0;
    options.cutOff = 0.0;
    BindReport report;
    const Binding binding = bind(ball, skeleton, options, &report);
    expectSound(binding);
    EXPECT_GT(report.cappedVertices, 50u);
    options.maxPartialInfluences = 8;
    BindReport free;
    bind(ball, skeleton, options, &free);
    EXPECT_EQ(free.cappedVertices, 0u);
    std::size_t corner = 0;
    float steepest = 0.0f;
    for (const std::uint32_t size : ball.faceSizes) {
        for (std::uint32_t k = 0; k < size; ++k)
            for (std::size_t j = 1; j < binding.joints.size(); ++j) {
                const std::uint32_t a = ball.faceVertices[corner + k];
                const std::uint32_t b = ball.faceVertices[corner + (k + 1) % size];
                steepest = std::fmax(steepest, std::abs(ratiosOf(binding, a, j).bend -
                                                        ratiosOf(binding, b, j).bend));
            }
        corner += size;
    }
    EXPECT_LT(steepest, 0.3f); // rounding only the surplus joints would make steps of up to 0.5
}

// CMU's hip joints, which have no skin of their own, bend it as the thighs below them do. In the
// cleft of the buttocks both thighs meet the spine.
TEST(Ratios, JointsThatBeginALimbTogetherCountOnce) {
    const std::vector<JointRatio> cleft = {{0, 1.0, 1.0},   {1, 0.1, 0.1},   {2, 0.08, 0.08},
                                           {3, 0.08, 0.01}, {4, 0.07, 0.07}, {5, 0.07, 0.02}};
    std::vector<Influence> packed;
    EXPECT_FALSE(packInfluences(cleft, 4, packed));
    ASSERT_EQ(packed.size(), cleft.size());
    for (std::size_t i = 0; i < cleft.size(); ++i) {
        EXPECT_FLOAT_EQ(packed[i].bend, static_cast<float>(cleft[i].bend)) << i;
        EXPECT_FLOAT_EQ(packed[i].twist, static_cast<float>(cleft[i].twist)) << i;
    }
    std::vector<JointRatio> chain; // all that the runtime can split, and one more
    for (std::uint32_t j = 0; j < 9; ++j) chain.push_back({j, 0.3, 0.3 - 0.01 * j});
    packed.clear();
    EXPECT_TRUE(packInfluences(chain, 4, packed));
}

TEST(Ratios, AreDeterministic) {
    const SkinMesh mesh = shapes::hangingArms();
    const Binding a = bind(mesh, shapes::hangingArmsSkeleton());
    const Binding b = bind(mesh, shapes::hangingArmsSkeleton());
    ASSERT_EQ(a.regions, b.regions);
    ASSERT_EQ(a.influences.size(), b.influences.size());
    for (std::size_t i = 0; i < a.influences.size(); ++i) {
        ASSERT_EQ(a.influences[i].bend, b.influences[i].bend);
        ASSERT_EQ(a.influences[i].twist, b.influences[i].twist);
    }
}

/// A ratio for every joint at every vertex would take 480 MB.
TEST(Ratios, AreStoredSparsely) {
    const SkinMesh mesh = shapes::cylinder(80.0);
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 40.0}, 79.0);
    while (skeleton.joints.size() < 6000) {
        const auto j = static_cast<double>(skeleton.joints.size());
        shapes::addJoint(skeleton, "j" + std::to_string(skeleton.joints.size()), "joint0",
                         {0.1, 0.013 * j, 0.1});
        skeleton.joints.back().tip = skeleton.joints.back().centre + glm::dvec3(0.1, 0.1, 0.0);
    }
    const auto before = peakMemory();
    const Binding binding = bind(mesh, skeleton);
#ifndef __SANITIZE_ADDRESS__ // the sanitizer keeps freed memory for a while
    EXPECT_LT(peakMemory() - before, 100);
#else
    static_cast<void>(before);
#endif
    EXPECT_EQ(binding.vertexCount(), mesh.positions.size());
}

/// A vertex of a chain's last joint has ratios for all joints, one of its first joint only for that
/// one.
TEST(Ratios, MaxInfluencesIsEnforced) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.0, 4.0, 6.0}, 7.0);
    BindOptions options;
    std::size_t above = 0;
    for (const std::uint32_t region : bind(mesh, skeleton, options).regions) above += region + 1;
    options.maxInfluences = above;
    EXPECT_NO_THROW(bind(mesh, skeleton, options));
    options.maxInfluences = above - 1;
    try {
        bind(mesh, skeleton, options);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.what(), "bind: " + std::to_string(mesh.positions.size()) +
                                    " vertices that follow chains of up to 3 joints have " +
                                    std::to_string(above) +
                                    " influences together, expected at most " +
                                    std::to_string(above - 1) + " (option maxInfluences)");
    }
}

/// Each vertex has every joint of a long chain above it: the binding itself takes 36 bytes for
/// each.
TEST(Ratios, LongChainNeedsLittleTemporaryMemory) {
    const SkinMesh mesh = shapes::cylinder(80.0);
    RestSkeleton skeleton = shapes::chainAlongY({1.0}, 1.0);
    for (int j = 1; j < 700; ++j)
        shapes::addJoint(skeleton, "chain" + std::to_string(j), skeleton.joints.back().name,
                         {0.0, 1.0 + 1e-4 * j, 0.0});
    skeleton.joints.back().tip = glm::dvec3(0.0, 79.0, 0.0);
    const auto before = peakMemory();
    const Binding binding = bind(mesh, skeleton);
    ASSERT_GT(binding.influences.size(), 600 * mesh.positions.size());
    ASSERT_EQ(binding.gradients.size(), binding.influences.size());
#ifndef __SANITIZE_ADDRESS__ // the sanitizer keeps freed memory for a while
    const auto influences = static_cast<long>(binding.influences.size());
    EXPECT_LT(peakMemory() - before, influences * 90 / 1'048'576);
#else
    static_cast<void>(before);
#endif
}
