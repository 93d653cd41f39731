// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidJoints>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

using namespace osgSkin;

namespace {

/// Number of connected patches of each region.
std::map<std::uint32_t, std::size_t> patchCounts(const SkinMesh& mesh, const Binding& binding) {
    std::vector<std::size_t> root(mesh.positions.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&root](std::size_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t a = corners[i], b = corners[i - i % 3 + (i + 1) % 3];
        if (binding.regions[a] == binding.regions[b]) root[find(a)] = find(b);
    }
    std::set<std::size_t> patches;
    std::map<std::uint32_t, std::size_t> counts;
    for (std::size_t v = 0; v < root.size(); ++v)
        if (patches.insert(find(v)).second) ++counts[binding.regions[v]];
    return counts;
}

const BindReport::Region* regionOf(const BindReport& report, const std::string& joint) {
    for (const BindReport::Region& region : report.regions)
        if (region.joint == joint) return &region;
    return nullptr;
}

bool hasNote(const BindReport& report, const std::string& part) {
    for (const std::string& note : report.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

} // namespace

TEST(Regions, ArmBesideTheTrunkIsTheArms) {
    const SkinMesh mesh = shapes::hangingArms();
    BindReport report;
    const Binding binding = bind(mesh, shapes::hangingArmsSkeleton(), {}, &report);
    expectSound(binding);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_EQ(report.openEdges, 0u);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        if (p.y > 0.0) continue; // the shoulders
        const std::string& joint = binding.joints[binding.regions[v]].name;
        const std::string side = p.x < 0 ? "right" : "left";
        if (std::abs(p.x) > 1.2)
            EXPECT_EQ(joint.substr(0, side.size()), side) << "arm vertex at height " << p.y;
        else
            EXPECT_TRUE(joint == "hips" || joint == "chest") << joint << " on the trunk";
    }
}

TEST(Regions, AreConnected) {
    const SkinMesh mesh = shapes::hangingArms();
    BindReport report;
    const Binding binding = bind(mesh, shapes::hangingArmsSkeleton(), {}, &report);
    const auto counts = patchCounts(mesh, binding);
    EXPECT_EQ(counts.size(), 8u);
    for (const auto& [joint, patches] : counts)
        EXPECT_EQ(patches, 1u) << binding.joints[joint].name;
    std::size_t sum = 0;
    for (const BindReport::Region& region : report.regions) {
        EXPECT_GT(region.seeds, 0u) << region.joint;
        EXPECT_GE(region.vertices, region.seeds / 2) << region.joint;
        sum += region.vertices;
    }
    EXPECT_EQ(sum, mesh.positions.size());
}

TEST(Regions, ReportNamesTheSeeds) {
    const SkinMesh mesh = shapes::exploded(shapes::hangingArms());
    BindReport report;
    const Binding binding = bind(mesh, shapes::hangingArmsSkeleton(), {}, &report);
    ASSERT_EQ(report.seeds.size(), mesh.positions.size());
    std::map<std::int32_t, std::set<std::array<double, 3>>> places; // copies count once
    for (std::size_t v = 0; v < report.seeds.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        if (report.seeds[v] >= 0) places[report.seeds[v]].insert({p.x, p.y, p.z});
    }
    for (const BindReport::Region& region : report.regions) {
        std::size_t seeds = 0;
        for (const auto& [joint, seen] : places)
            if (binding.joints[std::size_t(joint)].name == region.joint) seeds += seen.size();
        EXPECT_EQ(seeds, region.seeds) << region.joint;
    }
}

TEST(Regions, SeamsDoNotStopThem) {
    const SkinMesh mesh = shapes::hangingArms();
    const SkinMesh split = shapes::exploded(mesh);
    BindReport report;
    const Binding whole = bind(mesh, shapes::hangingArmsSkeleton());
    const Binding pieces = bind(split, shapes::hangingArmsSkeleton(), {}, &report);
    EXPECT_EQ(report.vertices, split.positions.size());
    EXPECT_EQ(report.weldedVertices, mesh.positions.size());
    EXPECT_EQ(report.shells, 1u);
    for (std::size_t i = 0; i < split.positions.size(); ++i) {
        const std::uint32_t v = mesh.faceVertices[i];
        ASSERT_EQ(pieces.regions[i], whole.regions[v]);
        for (std::size_t j = 0; j < whole.joints.size(); ++j)
            ASSERT_NEAR(ratiosOf(pieces, i, j).bend, ratiosOf(whole, v, j).bend, 1e-5);
    }
    // Copies of one vertex are identical, or the seam would open.
    std::map<std::uint32_t, std::size_t> first;
    for (std::size_t i = 0; i < split.positions.size(); ++i) {
        const std::size_t copy = first.emplace(mesh.faceVertices[i], i).first->second;
        for (std::size_t j = 0; j < whole.joints.size(); ++j) {
            ASSERT_EQ(ratiosOf(pieces, i, j).bend, ratiosOf(pieces, copy, j).bend);
            ASSERT_EQ(ratiosOf(pieces, i, j).twist, ratiosOf(pieces, copy, j).twist);
        }
    }
}

TEST(Regions, SeamsMayBeOffByRounding) {
    const SkinMesh mesh = shapes::hangingArms();
    BindReport report;
    SkinMesh split = shapes::exploded(mesh);
    for (const double off : {1e-9, 1e-6}) { // the body's size is 6, single precision's step 5e-7
        for (std::size_t i = 0; i < split.positions.size(); ++i)
            split.positions[i].x += off * static_cast<double>(i % 3);
        bind(split, shapes::hangingArmsSkeleton(), {}, &report);
        EXPECT_EQ(report.weldedVertices, mesh.positions.size());
        EXPECT_EQ(report.shells, 1u);
    }
    for (std::size_t i = 0; i < split.positions.size(); ++i)
        split.positions[i].x += 1e-3 * static_cast<double>(i % 3); // a different position
    bind(split, shapes::hangingArmsSkeleton(), {}, &report);
    EXPECT_GT(report.weldedVertices, mesh.positions.size());
}

TEST(Regions, ShellWithoutADelaunayEdgeTakesTheNearest) {
    // Two buttons at the far end of a cylinder: no joint lies inside them, and the skin hides all
    // joints.
    const SkinMesh tube = shapes::cylinder();
    const SkinMesh button = shapes::moved(shapes::cylinder(0.5), {0, 0, 0}, 0.05);
    const SkinMesh mesh = shapes::joined(shapes::joined(tube, shapes::moved(button, {1.2, 6.0, 0})),
                                         shapes::moved(button, {0, 1.0, -1.2}));
    BindReport report;
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0), {}, &report);
    expectSound(binding);
    EXPECT_EQ(report.shells, 3u);
    EXPECT_EQ(report.unassigned, 0u);
    const std::size_t end = tube.positions.size() + button.positions.size();
    for (std::size_t v = tube.positions.size(); v < mesh.positions.size(); ++v) {
        EXPECT_EQ(binding.regions[v], v < end ? 1u : 0u) << "vertex " << v;
        EXPECT_EQ(ratiosOf(binding, v, 1).bend, v < end ? 1.0f : 0.0f) << "vertex " << v;
    }
}

TEST(Regions, JointOutsideTheSkinHasNone) {
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    shapes::addJoint(skeleton, "hat", "joint1", {0, 12, 0});
    BindReport report;
    const Binding binding = bind(shapes::cylinder(), skeleton, {}, &report);
    expectSound(binding);
    EXPECT_TRUE(hasNote(report, "\"hat\" lies outside the skin"));
    EXPECT_EQ(regionOf(report, "hat"), nullptr);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        ASSERT_EQ(ratiosOf(binding, v, 2).bend, 0.0f);
}

TEST(Regions, JointOutsideInTheMiddleOfAChainStillBends) {
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1, 7.0}, 7.6);
    skeleton.joints[1].centre.x = 1.2; // the elbow is outside the skin, whose radius is 1
    const SkinMesh mesh = shapes::cylinder();
    BindReport report;
    const Binding binding = bind(mesh, skeleton, {}, &report);
    expectSound(binding);
    const BindReport::Region* region = regionOf(report, "joint1");
    ASSERT_NE(region, nullptr);
    EXPECT_GT(region->seeds, 0u) << "its bone leads back into the skin";
    EXPECT_GT(region->vertices, 50u);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const double height = mesh.positions[v].y;
        if (height < 1.5) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 0.0f) << "at " << height;
        }
        if (height > 6.5) {
            EXPECT_EQ(ratiosOf(binding, v, 1).bend, 1.0f) << "at " << height;
        }
    }
}

/// Its region begins beside it, not halfway between the joints inside the skin.
TEST(Regions, OfAJointOutsideBeginBesideIt) {
    std::size_t above = 0; // the rings that the joint above keeps
    for (const double height : {2.5, 4.1, 5.5}) {
        RestSkeleton skeleton = shapes::chainAlongY({1.1, height, 7.0}, 7.6);
        skeleton.joints[1].centre.x = 1.2;
        const Binding binding = bind(shapes::cylinder(), skeleton);
        const auto count = static_cast<std::size_t>(
            std::count(binding.regions.begin(), binding.regions.end(), 0u));
        EXPECT_GT(count, above + 50) << "at " << height;
        above = count;
    }
}

TEST(Regions, JointsBesideEachOtherInOnePointHaveThatOfTheirBones) {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "chest", "", {0, 1, 0});
    shapes::addJoint(skeleton, "leftHip", "chest", {0, -3, 0});
    shapes::addJoint(skeleton, "rightHip", "chest", {0, -3, 0});
    shapes::addJoint(skeleton, "left", "leftHip", {1.6, -0.9, 0});
    shapes::addJoint(skeleton, "right", "rightHip", {-1.6, -0.9, 0});
    BindReport report;
    expectSound(bind(shapes::hangingArms(), skeleton, {}, &report));
    ASSERT_NE(regionOf(report, "leftHip"), nullptr);
    ASSERT_NE(regionOf(report, "rightHip"), nullptr);
    EXPECT_GT(regionOf(report, "leftHip")->vertices, 0u);
    EXPECT_GT(regionOf(report, "rightHip")->vertices, 0u);

    // The printed method uses joint centres only.
    BindOptions printed;
    printed.method = BindOptions::Method::Paper;
    bind(shapes::hangingArms(), skeleton, printed, &report);
    EXPECT_EQ(regionOf(report, "leftHip"), nullptr);
    EXPECT_EQ(regionOf(report, "rightHip"), nullptr);
    EXPECT_NE(report.text().find("\"leftHip\" and \"rightHip\" are at one point"),
              std::string::npos);
}

/// A root on the floor, as in games: all skin follows it fully, and rotates with the hips.
TEST(Regions, ARootOutsideHasNoSkin) {
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.0, 6.0, 7.0}, 7.6);
    const char* const names[] = {"Hips", "Spine", "Neck", "Head"};
    for (std::size_t j = 0; j < 4; ++j) skeleton.joints[j].name = names[j];
    RestSkeleton with;
    with.add("ground", -1, glm::dvec3(0.0, -3.0, 0.0));
    for (RestJoint joint : skeleton.joints) {
        ++joint.parent;
        with.joints.push_back(joint);
    }
    for (const BindOptions::Method method :
         {BindOptions::Method::Smooth, BindOptions::Method::Paper}) {
        BindOptions options;
        options.method = method;
        const Binding binding = bind(shapes::cylinder(), with, options);
        EXPECT_EQ(std::count(binding.regions.begin(), binding.regions.end(), 0u), 0);
        for (const Influence& influence : binding.influences)
            if (influence.joint == 1) {
                EXPECT_EQ(influence.bend, 1.0f);
                EXPECT_EQ(influence.twist, 1.0f);
            }
    }
}

/// Targets, twist bones and copies of another rig share a joint's position, and take no skin from
/// it.
TEST(Regions, AHelperInAJointsPlaceTakesNoSkin) {
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.0, 7.0}, 7.6);
    const Binding plain = bind(shapes::cylinder(), skeleton);
    RestSkeleton with = skeleton;
    with.add("target", 0, skeleton.joints[1].centre);
    BindReport report;
    const Binding binding = bind(shapes::cylinder(), with, {}, &report);
    EXPECT_EQ(binding.regions, plain.regions);
    EXPECT_EQ(regionOf(report, "target"), nullptr);
    // Links of a twist, the first one at the joint's position.
    RestSkeleton known = shapes::chainAlongY({1.1, 2.5, 4.0, 7.0}, 7.6);
    const char* const names[] = {"LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"};
    for (std::size_t j = 0; j < 4; ++j) known.joints[j].name = names[j];
    RestSkeleton twisted = known;
    const int twist = twisted.add("LeftForeArmTwist", 1, known.joints[2].centre);
    twisted.add("LeftForeArmTwist1", twist, glm::dvec3(0.0, 5.5, 0.0));
    EXPECT_EQ(bind(shapes::cylinder(), twisted).regions, bind(shapes::cylinder(), known).regions);

    // The reverse: the helper comes first in its file.
    RestSkeleton first;
    first.joints.push_back(skeleton.joints[0]);
    first.add("target", 0, skeleton.joints[1].centre);
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        first.joints.push_back(skeleton.joints[j]);
        if (first.joints.back().parent > 0) ++first.joints.back().parent;
    }
    const Binding other = bind(shapes::cylinder(), first);
    for (std::size_t v = 0; v < plain.regions.size(); ++v)
        ASSERT_EQ(other.regions[v], plain.regions[v] == 0 ? 0u : plain.regions[v] + 1) << v;
}

TEST(Regions, WithoutAnyJointInsideGoToTheNearestBone) {
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 4.0}, 8.0);
    for (RestJoint& joint : skeleton.joints) joint.centre.x += 5.0;
    skeleton.joints.back().tip = glm::dvec3(5, 8, 0);
    const SkinMesh mesh = shapes::cylinder();
    BindReport report;
    const Binding binding = bind(mesh, skeleton, {}, &report);
    expectSound(binding);
    EXPECT_TRUE(hasNote(report, "no joint lies inside"));
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double height = mesh.positions[v].y;
        if (height < 3.0 || height > 5.0) {
            EXPECT_EQ(binding.regions[v], height < 3.0 ? 0u : 1u) << "at " << height;
        }
    }
}

TEST(Regions, ReportSaysWhatWasFound) {
    BindReport report;
    bind(shapes::hangingArms(), shapes::hangingArmsSkeleton(), {}, &report);
    const std::string text = report.text();
    EXPECT_NE(text.find("shells 1"), std::string::npos) << text;
    EXPECT_NE(text.find("unassigned vertices 0"), std::string::npos) << text;
    EXPECT_NE(text.find("region leftElbow: "), std::string::npos) << text;
    EXPECT_EQ(text.back(), '\n');
    EXPECT_GT(report.seconds, 0.0);
}

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

/// A forearm along y with a hand of two fingers, each one bone with a tip.
RestSkeleton handSkeleton() {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "LeftArm", "", {0, 0, 0});
    shapes::addJoint(skeleton, "LeftForeArm", "LeftArm", {0, 4, 0});
    shapes::addJoint(skeleton, "LeftHand", "LeftForeArm", {0, 8, 0});
    shapes::addJoint(skeleton, "LeftHandIndex1", "LeftHand", {0, 9, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 11, 0);
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

// A head that ends in an open neck is no closed shell, but its eyes are: they must not be all that
// the head joint gets.
TEST(Ownership, AnOpenHeadWithEyesIsTheHeads) {
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

TEST(Ownership, PiecesThatShareVerticesAreOne) {
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

TEST(Ownership, RingsFarApartDoNotLetABendReachTheNextJoint) {
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

TEST(Ownership, LegsThatAreShellsFollowTheirBones) {
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

TEST(Ownership, TheMiddleOfASkirtFollowsBothThighsAlike) {
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

TEST(Ownership, AShellAroundOthersMayBeInverted) {
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

TEST(Ownership, ALimbWithoutSkinIsReported) {
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

/// Painters assign these vertices to the head or a joint, or do not; the limits are a rigger's.
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
