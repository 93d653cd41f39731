// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which joint the skin of separate shells follows.
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

/// A closed box with its own vertices.
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

/// Trunk, two arms and a head as boxes: their sides touch, corner to corner.
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

/// A tube along y with rings of eight vertices at these heights, closed at both ends.
SkinMesh tube(const glm::dvec3& centre, double radius, const std::vector<double>& heights,
              bool isInverted = false) {
    constexpr std::uint32_t kSides = 8;
    SkinMesh mesh;
    for (const double y : heights)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const double angle = 0.25 * std::acos(-1.0) * side;
            mesh.positions.emplace_back(centre.x + radius * std::cos(angle), y,
                                        centre.z + radius * std::sin(angle));
        }
    const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - kSides;
    const auto face = [&](std::vector<std::uint32_t> corners) {
        if (isInverted) std::reverse(corners.begin(), corners.end());
        mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
        mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
    };
    std::vector<std::uint32_t> bottom, top;
    for (std::uint32_t side = 0; side < kSides; ++side) {
        const std::uint32_t next = (side + 1) % kSides;
        for (std::uint32_t ring = 0; ring < last; ring += kSides)
            face({ring + side, ring + kSides + side, ring + kSides + next, ring + next});
        bottom.push_back(side);
        top.push_back(last + kSides - 1 - side);
    }
    face(bottom);
    face(top);
    return mesh;
}

/// A trunk and two legs that end in it; the root is on the floor.
RestSkeleton modularSkeleton() {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "Root", "", {0, 0, 0});
    shapes::addJoint(skeleton, "Hips", "Root", {0, 10, 0});
    shapes::addJoint(skeleton, "Spine", "Hips", {0, 11, 0});
    shapes::addJoint(skeleton, "Neck", "Spine", {0, 15, 0});
    shapes::addJoint(skeleton, "Head", "Neck", {0, 16, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 18, 0);
    for (const double side : {1.0, -1.0}) {
        const std::string name = side > 0.0 ? "Left" : "Right";
        shapes::addJoint(skeleton, name + "UpLeg", "Hips", {side, 10.2, 0});
        shapes::addJoint(skeleton, name + "Leg", name + "UpLeg", {side, 6, 0});
        shapes::addJoint(skeleton, name + "Foot", name + "Leg", {side, 1.8, 0});
        skeleton.joints.back().tip = glm::dvec3(side, 0.5, 1.5);
    }
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

TEST(Ownership, TouchingBoxesFollowOneJointEach) {
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

// A head that ends in an open neck is no closed shell, but its eyes are: they must not be all that
// the head joint gets.
TEST(Ownership, OpenHeadWithEyesFollowsTheHeadJoint) {
    SkinMesh head = tube({0, 0, 0}, 1.0, {14.5, 15.2, 15.9, 16.6, 17.3, 18.0});
    head.faceSizes.erase(head.faceSizes.end() - 2); // the bottom
    head.faceVertices.erase(head.faceVertices.end() - 16, head.faceVertices.end() - 8);
    const SkinMesh trunk = tube({0, 0, 0}, 0.9, {8, 9, 10, 11, 12, 13, 14, 15});
    const SkinMesh eyes = shapes::joined(box({0.3, 16.8, 0.5}, {0.5, 17.0, 0.7}),
                                         box({-0.5, 16.8, 0.5}, {-0.3, 17.0, 0.7}));
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "Hips", "", {0, 9, 0});
    shapes::addJoint(skeleton, "Spine", "Hips", {0, 11, 0});
    shapes::addJoint(skeleton, "Neck", "Spine", {0, 15, 0});
    shapes::addJoint(skeleton, "Head", "Neck", {0, 16, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 17.9, 0);
    shapes::addJoint(skeleton, "LeftEye", "Head", {0.4, 16.9, 0.6});
    shapes::addJoint(skeleton, "RightEye", "Head", {-0.4, 16.9, 0.6});
    const SkinMesh mesh = shapes::joined(shapes::joined(head, trunk), eyes);
    const Binding binding = bind(mesh, skeleton);
    const std::size_t joint = jointCalled(binding, "Head");
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].y > 16.5) {
            EXPECT_EQ(ratiosOf(binding, v, joint).bend, 1.0f) << v;
        }
}

TEST(Ownership, PiecesThatShareVerticesAreOneShell) {
    SkinMesh mesh = shapes::joined(box({0, 0, 0}, {1, 4, 1}), box({1, 0, 0}, {2, 4, 1}));
    for (std::uint32_t& corner :
         mesh.faceVertices) // the second box's left side coincides with the first's right side
        if (corner >= 8 && corner % 2 == 0) corner -= 7;
    BindReport report;
    bind(mesh, shapes::chainAlongY({0.5, 2.0}, 3.5), {}, &report);
    EXPECT_EQ(report.shells, 1u);
}

TEST(Ownership, ControlsAndRootsOnTheFloorOwnNothing) {
    // A tube from y = 2 up, its root far below, a target beside it and another one inside it.
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

TEST(Ownership, LastJointWithoutTipReachesTheEndOfTheSkin) {
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 6.0}, 11.0);
    skeleton.joints.back().tip.reset();
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, skeleton);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].y > 9.0) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << v;
        }
}

/// Many rigs end their chains with joints that nobody paints.
TEST(Ownership, JointsAboveASkippedEndKeepTheirSkin) {
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 6.0, 11.0}, 11.5);
    skeleton.joints.back().tip.reset();
    BindOptions options;
    options.joints["joint2"].skip = true;
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, skeleton, options);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].y > 9.0) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << v;
        }
}

TEST(Ownership, ShortThickLimbsBendOnlyAtTheirJoints) {
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

TEST(Ownership, BendStopsAtTheNextJointOnSparseRings) {
    RestSkeleton skeleton = shapes::chainAlongY({0.5, 4.0, 5.8, 8.4}, 10.0);
    const char* names[] = {"Chest", "LeftArm", "LeftForeArm", "LeftHand"};
    for (std::size_t j = 0; j < 4; ++j) skeleton.joints[j].name = names[j];
    const SkinMesh mesh = tube({0, 0, 0}, 1.0, {0, 2, 4, 5.8, 6.6, 7.4, 8.4, 10});
    const Binding binding = bind(mesh, skeleton);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const double y = mesh.positions[v].y;
        if (y > 5.7) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << "elbow and beyond: " << y;
        }
        if (y < 4.1) {
            EXPECT_EQ(ratiosOf(binding, v, 2).bend, 0.0f) << "shoulder and above: " << y;
        }
    }
}

TEST(Ownership, SeparateLegShellsFollowTheirBones) {
    const std::vector<double> trunk{7.4, 8.2, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18};
    const std::vector<double> leg{0.4, 1.2, 3.5, 5.4, 6, 6.6, 7.4, 8.2};
    for (const bool isInverted : {false, true}) {
        SkinMesh mesh =
            shapes::joined(tube({1, 0, 0}, 0.8, leg, isInverted), tube({-1, 0, 0}, 0.8, leg));
        const std::size_t legs = mesh.positions.size();
        mesh = shapes::joined(mesh, tube({0, 0, 0}, 2.0, trunk));
        const Binding binding = bind(mesh, modularSkeleton());
        expectSound(binding);
        for (std::size_t v = 0; v < legs; ++v) {
            const std::string side = mesh.positions[v].x > 0.0 ? "Left" : "Right";
            EXPECT_EQ(ratiosOf(binding, v, jointCalled(binding, side + "UpLeg")).bend, 1.0f)
                << mesh.positions[v].y;
            const double knee = ratiosOf(binding, v, jointCalled(binding, side + "Leg")).bend;
            if (mesh.positions[v].y > 7.3) {
                EXPECT_LT(knee, 0.02);
            }
            if (mesh.positions[v].y < 4.0) {
                EXPECT_GT(knee, 0.98);
            }
        }
    }
}

TEST(Ownership, SkirtMiddleFollowsBothThighs) {
    SkinMesh skirt = tube({0, 0, 0}, 2.4, {5, 6, 7, 8, 9, 10, 11});
    skirt.faceSizes.resize(skirt.faceSizes.size() - 2); // open below and above
    skirt.faceVertices.resize(skirt.faceVertices.size() - 16);
    const std::vector<double> heights = {0.5, 2, 4, 6, 8, 9.9};
    const SkinMesh legs =
        shapes::joined(tube({1, 0, 0}, 0.8, heights), tube({-1, 0, 0}, 0.8, heights));
    const SkinMesh trunk = tube({0, 0, 0}, 1.9, {9.8, 11, 12, 13, 14, 15, 16, 17, 18});
    const Binding binding =
        bind(shapes::joined(skirt, shapes::joined(trunk, legs)), modularSkeleton());
    const std::size_t left = jointCalled(binding, "LeftUpLeg");
    const std::size_t right = jointCalled(binding, "RightUpLeg");
    for (std::size_t v = 0; v < skirt.positions.size(); ++v) {
        const glm::dvec3& p = skirt.positions[v];
        if (std::abs(p.x) > 1e-6 || p.y > 7.5) continue;
        const float lefts = ratiosOf(binding, v, left).bend;
        EXPECT_NEAR(lefts, ratiosOf(binding, v, right).bend, 0.03f) << v;
        EXPECT_GT(lefts, 0.2f) << v;
    }
}

TEST(Ownership, InvertedOuterShellBindsAlike) {
    const SkinMesh limb = shapes::cylinder(12.0);
    const RestSkeleton skeleton = shapes::chainAlongY({0.5, 6.0}, 11.5);
    const auto around = [](bool isInverted) {
        SkinMesh mesh = tube({0, 0, 0}, 2.5, {1, 4, 8, 11}, isInverted);
        for (int cap = 0; cap < 2; ++cap) { // open at both ends
            mesh.faceVertices.resize(mesh.faceVertices.size() - 8);
            mesh.faceSizes.pop_back();
        }
        return mesh;
    };
    const Binding expected = bind(shapes::joined(limb, around(false)), skeleton);
    const Binding found = bind(shapes::joined(limb, around(true)), skeleton);
    for (std::size_t v = 0; v < expected.regions.size(); ++v)
        EXPECT_NEAR(ratiosOf(found, v, 1).bend, ratiosOf(expected, v, 1).bend, 1e-6) << v;
    const std::size_t top = limb.positions.size() - 1;
    EXPECT_EQ(ratiosOf(found, top, 1).bend, 1.0f);
}

TEST(Ownership, ReportsLimbsWithoutSkin) {
    // Both bones coincide; either of the two may own the skin.
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

class RealOwnership : public testing::TestWithParam<PaintedCase> {};

/// Painters assign these vertices to the head or a joint, or do not; the limits are a rigger's.
TEST_P(RealOwnership, AgreesWithPaintedWeights) {
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
        if (!rigid) continue; // painters disagree about fingers
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
