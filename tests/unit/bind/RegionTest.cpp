// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkinBind/Bind>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

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

TEST(Regions, ArmBesideTheTrunkBelongsToTheArm) {
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

TEST(Regions, ReportListsSeeds) {
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

TEST(Regions, CrossSeams) {
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

TEST(Regions, CrossSeamsWithRoundingErrors) {
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

TEST(Regions, ShellWithoutDelaunayEdgesFollowsTheNearestJoint) {
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

TEST(Regions, JointOutsideTheSkinGetsNone) {
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

TEST(Regions, MiddleJointOutsideTheSkinStillBends) {
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
TEST(Regions, MiddleJointOutsideTheSkinStartsItsRegionBesideIt) {
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

TEST(Regions, SiblingsAtOnePointGetTheirBonesRegions) {
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
TEST(Regions, RootOutsideTheSkinGetsNone) {
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
TEST(Regions, HelperAtAJointGetsNone) {
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

TEST(Regions, FollowTheNearestBoneWithoutJointsInside) {
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

TEST(Regions, ChainThatRunsBackPastTheHeadHasItsSkin) {
    RestSkeleton snake;
    shapes::addJoint(snake, "root", "", {0, 37.5, 0});
    shapes::addJoint(snake, "head", "root", {0, 38.4, 0});
    shapes::addJoint(snake, "head_tip", "head", {0, 39.7, 0});
    for (int k = 1; k <= 20; ++k)
        shapes::addJoint(snake, "tail" + std::to_string(k),
                         k == 1 ? "head" : "tail" + std::to_string(k - 1),
                         {0, 37.67 - 1.8 * (k - 1), 0});
    BindReport report;
    const SkinMesh mesh = shapes::cylinder(40.0);
    const Binding binding = bind(mesh, snake, {}, &report);
    expectSound(binding);
    for (int k = 1; k <= 20; ++k) {
        const BindReport::Region* const ring = regionOf(report, "tail" + std::to_string(k));
        ASSERT_TRUE(ring != nullptr) << k;
        EXPECT_GE(ring->vertices, 16u) << k;
        EXPECT_LE(ring->vertices, mesh.positions.size() / 10) << k;
    }
    EXPECT_EQ(report.bareJoints, std::vector<std::string>());
}

/// Each of its bones is short.
TEST(Regions, ReportsChainWithoutSkin) {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "root", "", {0, 0.5, 0});
    const glm::dvec3 places[] = {{0, 1, 0}, {0.5, 1, 0}, {-0.5, 1, 0}, {0, 1, 0.5}, {0, 1, -0.5}};
    for (int chain = 0; chain < 5; ++chain)
        for (int k = 0; k < 10; ++k) {
            const std::string name = std::string(1, char('a' + chain));
            shapes::addJoint(skeleton, name + std::to_string(k),
                             k == 0 ? "root" : name + std::to_string(k - 1),
                             places[chain] + glm::dvec3(0, 0.5 * k, 0));
        }
    BindReport report;
    bind(shapes::cylinder(), skeleton, {}, &report);
    EXPECT_NE(std::find(report.bareJoints.begin(), report.bareJoints.end(), "a5"),
              report.bareJoints.end())
        << report.text();
}

TEST(Regions, ReportHasCounts) {
    BindReport report;
    bind(shapes::hangingArms(), shapes::hangingArmsSkeleton(), {}, &report);
    const std::string text = report.text();
    EXPECT_NE(text.find("shells 1"), std::string::npos) << text;
    EXPECT_NE(text.find("unassigned vertices 0"), std::string::npos) << text;
    EXPECT_NE(text.find("region leftElbow: "), std::string::npos) << text;
    EXPECT_EQ(text.back(), '\n');
    EXPECT_GT(report.seconds, 0.0);
}
