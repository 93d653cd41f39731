// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidJoints>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

namespace {

/// A closed box with vertices of its own.
SkinMesh box(const glm::dvec3& low, const glm::dvec3& high) {
    SkinMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                    i & 4 ? high.z : low.z);
    for (const std::uint32_t corner : {0u, 4u, 6u, 2u, 1u, 3u, 7u, 5u, 0u, 1u, 5u, 4u,
                                       2u, 6u, 7u, 3u, 0u, 2u, 3u, 1u, 4u, 5u, 7u, 6u})
        mesh.faceVertices.push_back(corner);
    mesh.faceSizes.assign(6, 4);
    return mesh;
}

/// Trunk, two arms and a head, box by box: their sides touch, corner on corner.
SkinMesh blocks() {
    const SkinMesh arms =
        shapes::joined(box({4, 12, -2}, {8, 24, 2}), box({-8, 12, -2}, {-4, 24, 2}));
    return shapes::joined(shapes::joined(box({-4, 12, -2}, {4, 24, 2}), arms),
                          box({-4, 24, -4}, {4, 32, 4}));
}

RestSkeleton blocksSkeleton() {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "Hips", "", {0, 13, 0});
    shapes::addJoint(skeleton, "Body", "Hips", {0, 16, 0});
    shapes::addJoint(skeleton, "Head", "Body", {0, 24, 0});
    shapes::addJoint(skeleton, "Arm_Left", "Body", {6, 22, 0});
    shapes::addJoint(skeleton, "Arm_Right", "Body", {-6, 22, 0});
    skeleton.joints[2].tip = glm::dvec3(0, 32, 0);
    skeleton.joints[3].tip = glm::dvec3(6, 12, 0);
    skeleton.joints[4].tip = glm::dvec3(-6, 12, 0);
    return skeleton;
}

/// A forearm along y with a hand of two fingers, each a bone with a tip.
RestSkeleton handSkeleton() {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "LeftArm", "", {0, 0, 0});
    shapes::addJoint(skeleton, "LeftForeArm", "LeftArm", {0, 4, 0});
    shapes::addJoint(skeleton, "LeftHand", "LeftForeArm", {0, 8, 0});
    shapes::addJoint(skeleton, "LeftHandIndex1", "LeftHand", {0, 9, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 11, 0);
    return skeleton;
}

struct PaintedCase {
    const char* shape;
    const char* rig;
};

std::ostream& operator<<(std::ostream& out, const PaintedCase& body) {
    return out << body.shape << ", " << body.rig;
}

} // namespace

TEST(Ownership, BoxesThatTouchFollowOneJointEach) {
    const SkinMesh mesh = blocks();
    for (const SkinMesh& given : {mesh, shapes::exploded(mesh)}) {
        BindReport report;
        const Binding binding = bind(given, blocksSkeleton(), {}, &report);
        expectSound(binding);
        EXPECT_EQ(report.shells, 4u);
        const char* owners[] = {"Body", "Arm_Left", "Arm_Right", "Head"};
        const std::size_t each = given.positions.size() / 4;
        for (std::size_t v = 0; v < given.positions.size(); ++v) {
            const std::size_t owner = jointCalled(binding, owners[v / each]);
            EXPECT_EQ(binding.joints[binding.regions[v]].name, owners[v / each]) << v;
            EXPECT_EQ(ratiosOf(binding, v, owner).bend, 1.0f) << v;
            EXPECT_EQ(partialJoints(binding, v), 0u) << v;
        }
    }
}

TEST(Ownership, PiecesThatShareVerticesAreOne) {
    SkinMesh mesh = shapes::joined(box({0, 0, 0}, {1, 4, 1}), box({1, 0, 0}, {2, 4, 1}));
    for (std::uint32_t& corner :
         mesh.faceVertices) // the second box's left side is the first's right
        if (corner >= 8 && corner % 2 == 0) corner -= 7;
    BindReport report;
    bind(mesh, shapes::chainAlongY({0.5, 2.0}, 3.5), {}, &report);
    EXPECT_EQ(report.shells, 1u);
}

TEST(Ownership, ControlsAndRootsOnTheFloorOwnNothing) {
    // A tube from y = 2 up, its root far below, a target beside it and one inside it.
    const SkinMesh mesh = shapes::moved(shapes::cylinder(12.0), {0, 2, 0});
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "floor", "", {0, -20, 0});
    shapes::addJoint(skeleton, "base", "floor", {0, 3, 0});
    shapes::addJoint(skeleton, "middle", "base", {0, 8, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 13.5, 0);
    shapes::addJoint(skeleton, "target", "floor", {0.2, 11, 0});
    shapes::addJoint(skeleton, "pole", "floor", {0, 8, 9});
    BindReport report;
    const Binding binding = bind(mesh, skeleton, {}, &report);
    expectSound(binding);
    for (const BindReport::Region& region : report.regions)
        EXPECT_TRUE(region.joint == "base" || region.joint == "middle") << region.joint;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        for (const char* other : {"target", "pole"})
            EXPECT_EQ(ratiosOf(binding, v, jointCalled(binding, other)).bend, 0.0f) << other;
}

TEST(Ownership, LastJointsWithoutATipReachToTheEndOfTheSkin) {
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 6.0}, 11.0);
    skeleton.joints.back().tip.reset();
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, skeleton);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].y > 9.0) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << v;
        }
}

TEST(Ownership, LimbsAsShortAsThickBendAtTheirJointsOnly) {
    // Upper arm and forearm are 1.8 radii long.
    RestSkeleton skeleton = shapes::chainAlongY({0.5, 4.0, 5.8, 7.6}, 10.0);
    const char* names[] = {"Chest", "LeftArm", "LeftForeArm", "LeftHand"};
    for (std::size_t j = 0; j < 4; ++j) skeleton.joints[j].name = names[j];
    const SkinMesh mesh = shapes::cylinder(11.0);
    const Binding binding = bind(mesh, skeleton);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].y > 6.8) {
            EXPECT_GT(ratiosOf(binding, v, 1).bend, 0.99f) << "elbow and beyond";
        }
}

TEST(Ownership, ALimbWithoutSkinIsReported) {
    // Both bones are in one place, and one of the two can own the skin.
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 5.0}, 11.0);
    skeleton.joints.push_back({"slim", 0, {0.05, 5.0, 0.0}, glm::dvec3(0.05, 11.0, 0.0)});
    BindReport report;
    bind(shapes::cylinder(12.0), skeleton, {}, &report);
    for (const std::string& joint : report.bareJoints)
        EXPECT_TRUE(std::none_of(report.regions.begin(), report.regions.end(),
                                 [&](const BindReport::Region& region) {
                                     return region.joint == joint && region.vertices > 0;
                                 }))
            << joint;
}

TEST(RigidNames, HandsWithFingersBendUnlessNothingMovesThem) {
    const RestSkeleton skeleton = handSkeleton();
    EXPECT_TRUE(automaticRigidJoints(skeleton).empty());
    std::vector<bool> isMoved(skeleton.joints.size(), false);
    isMoved[1] = isMoved[2] = true;
    EXPECT_EQ(automaticRigidJoints(skeleton, {}, isMoved), std::vector<std::string>{"LeftHand"});
    isMoved[3] = true;
    EXPECT_TRUE(automaticRigidJoints(skeleton, {}, isMoved).empty());
}

class RealOwnership : public testing::TestWithParam<PaintedCase> {};

/// Painters give these vertices to the head or a joint, or not at all; the limits are a rigger's.
TEST_P(RealOwnership, IsAsPaintersHaveIt) {
    const auto [shape, rig] = GetParam();
    const auto folder = shared::makehuman();
    const auto meshFile = folder / "body" / ("body4k_" + std::string(shape) + ".obj");
    const auto rigFile = folder / "rig" / ("joints_" + std::string(rig) + "_" + shape + ".json");
    if (!std::filesystem::exists(meshFile) || !std::filesystem::exists(rigFile))
        GTEST_SKIP() << "needs " << meshFile << " and " << rigFile;
    const SkinMesh mesh = shared::readObj(meshFile);
    const RestSkeleton skeleton = shared::readJoints(rigFile);
    std::vector<std::vector<double>> painted =
        shared::readWeights(folder / "weights" / ("body4k_weights_" + std::string(rig) + ".json"),
                            skeleton, mesh.positions.size());
    for (auto& row : painted)
        for (std::size_t j = row.size(); j-- > 1;)
            row[static_cast<std::size_t>(skeleton.joints[j].parent)] += row[j];

    for (const bool rigid : {true, false}) {
        SCOPED_TRACE(rigid ? "by default" : "without rigid parts");
        BindOptions options;
        options.rigid = rigid ? automaticRigidJoints(
                                    skeleton, {}, std::vector<bool>(skeleton.joints.size(), false))
                              : std::vector<std::string>();
        const Binding binding = bind(mesh, skeleton, options);
        expectSound(binding);
        std::size_t inside = 0, outside = 0, head = 0, headWhole = 0;
        const std::size_t headJoint =
            std::min(jointCalled(binding, "head"), jointCalled(binding, "Head"));
        std::vector<bool> isLarge(skeleton.joints.size(), false);
        std::vector<bool> isUsed(isLarge.size(), false); // not below a rigid part
        for (const Influence& influence : binding.influences) isUsed[influence.joint] = true;
        for (std::size_t j = 0; j < isLarge.size(); ++j)
            isLarge[j] =
                isUsed[j] && std::count_if(painted.begin(), painted.end(), [&](const auto& row) {
                                 return row[j] > 0.99 * row[0];
                             }) >= 20;
        for (std::size_t v = 0; v < painted.size(); ++v) {
            bool isInside = false, isOutside = false;
            for (std::size_t j = 0; j < isLarge.size(); ++j) {
                const float ratio = ratiosOf(binding, v, j).bend;
                const double share = painted[v][j] / painted[v][0];
                if (j == headJoint && share > 0.99) {
                    ++head;
                    headWhole += ratio > 0.999f ? 1 : 0;
                }
                if (!isLarge[j]) continue;
                isInside = isInside || (share > 0.99 && ratio < 0.9f);
                isOutside = isOutside || (share < 0.01 && ratio > 0.1f);
            }
            inside += isInside ? 1 : 0;
            outside += isOutside ? 1 : 0;
        }
        EXPECT_GE(double(headWhole), 0.99 * double(head));
        if (!rigid) continue; // painters do not agree about fingers
        EXPECT_LE(100.0 * double(inside) / double(painted.size()), 3.0);
        EXPECT_LE(100.0 * double(outside) / double(painted.size()), 7.0);
    }
}

INSTANTIATE_TEST_SUITE_P(
    MakeHuman, RealOwnership,
    testing::Values(PaintedCase{"neutral", "cmu_mb"}, PaintedCase{"male", "cmu_mb"},
                    PaintedCase{"female", "cmu_mb"}, PaintedCase{"child", "cmu_mb"},
                    PaintedCase{"female_old", "cmu_mb"}, PaintedCase{"male_heavy", "cmu_mb"},
                    PaintedCase{"child", "game_engine"}, PaintedCase{"male_heavy", "game_engine"},
                    PaintedCase{"female_old", "default"}, PaintedCase{"male", "default"}));
