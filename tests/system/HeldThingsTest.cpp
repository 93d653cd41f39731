// SPDX-License-Identifier: MIT
// Shells near a hand or a head stay attached to it when the skin is bound by regions.
#include "DrawnSkin.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "GltfReference.h"
#include "SkinFiles.h"

#include <osgSkinCharacter/LoadCharacter>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <tuple>

namespace {

using osgSkin::Character;
using test::GltfBuilder;
using test::GltfColumn;

struct Joint {
    const char* name;
    int parent;
    double x, y;
};

/// An upper body in one piece, arms stretched out, with boxes beside it: a sword in the right hand
/// that points back to the shoulder, and a head that reaches down to the arms.
const Joint kJoints[] = {
    {"hips", -1, 0, 0},           {"spine", 0, 0, 0.5},        {"chest", 1, 0, 1.0},
    {"neck", 2, 0, 1.5},          {"head", 3, 0, 1.7},         {"upperarm.r", 2, -0.3, 1.3},
    {"lowerarm.r", 5, -0.9, 1.3}, {"hand.r", 6, -1.5, 1.3},    {"slot.r", 7, -1.7, 1.3},
    {"upperarm.l", 2, 0.3, 1.3},  {"lowerarm.l", 9, 0.9, 1.3}, {"hand.l", 10, 1.5, 1.3}};
constexpr int kHead = 4, kSlot = 8;

/// A plume on the head, of joints without roles.
const Joint kPlume[] = {{"plume1", kHead, 0, 3.0},
                        {"plume2", 12, 0, 3.4},
                        {"plume3", 13, 0, 3.8},
                        {"plume4", 14, 0, 4.2}};

struct Fighter : GltfBuilder {
    std::vector<double> places, corners, indices;
    std::size_t sword = 0, head = 0; ///< their first vertices, 8 each
    std::vector<std::size_t> joints;

    explicit Fighter(bool painted, bool isExploded = false, bool hasPlume = false) {
        std::vector<Joint> all(std::begin(kJoints), std::end(kJoints));
        if (hasPlume) all.insert(all.end(), std::begin(kPlume), std::end(kPlume));
        for (const Joint& joint : all) {
            const double x = joint.parent < 0 ? 0.0 : all[std::size_t(joint.parent)].x;
            const double y = joint.parent < 0 ? 0.0 : all[std::size_t(joint.parent)].y;
            joints.push_back(
                node({{"name", joint.name}, {"translation", {joint.x - x, joint.y - y, 0}}}));
            if (joint.parent >= 0)
                json["nodes"][std::size_t(joint.parent)]["children"].push_back(joints.back());
        }
        addBody();
        sword = addBox(-1.75, -0.4, 1.36, 1.44, 0.05, kSlot);
        head = addBox(-0.35, 0.35, 1.42, 2.3, 0.3, kHead);
        if (isExploded) explode();
        if (hasPlume) addPlume();
        nlohmann::json attributes = {{"POSITION", accessor("VEC3", places)}};
        if (painted) {
            std::vector<double> whole;
            for (std::size_t v = 0; v < places.size() / 3; ++v)
                whole.insert(whole.end(), {1, 0, 0, 0});
            attributes["JOINTS_0"] = accessor("VEC4", corners, 5121);
            attributes["WEIGHTS_0"] = accessor("VEC4", whole);
        }
        json["meshes"].push_back(
            {{"primitives",
              {{{"attributes", attributes}, {"indices", accessor("SCALAR", indices, 5123)}}}}});
        std::vector<double> matrices;
        for (const Joint& joint : all)
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k == 12      ? -joint.x
                                   : k == 13    ? -joint.y
                                   : k % 5 == 0 ? 1.0
                                                : 0.0);
        nlohmann::json body = {{"name", "body"}, {"mesh", 0}};
        if (painted) {
            json["skins"] = {
                {{"joints", joints}, {"inverseBindMatrices", accessor("MAT4", matrices)}}};
            body["skin"] = 0;
        }
        json["scenes"][0]["nodes"] = {0, node(body)};
        for (const char* name : {"upperarm.r", "hand.r", "neck", "head"})
            for (std::size_t j = 0; j < joints.size(); ++j)
                if (name == std::string(all[j].name))
                    animate("fight", joints[j], "rotation", {0.0, 1.0},
                            GltfColumn::turns({20, 50}));
    }

    /// Gives each corner of each triangle its own vertex, as in files with flat shading.
    void explode() {
        std::vector<double> all, joint;
        const std::size_t last = indices.size() - 36; // the head is the last box
        for (const double index : indices) {
            const auto v = static_cast<std::size_t>(index);
            for (std::size_t k = 0; k < 3; ++k) all.push_back(places[3 * v + k]);
            for (std::size_t k = 0; k < 4; ++k) joint.push_back(corners[4 * v + k]);
        }
        for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<double>(i);
        places = all;
        corners = joint;
        head = last;
    }

    std::size_t vertex(double x, double y, double z, int joint) {
        places.insert(places.end(), {x, y, z});
        corners.insert(corners.end(), {double(joint), 0, 0, 0});
        return places.size() / 3 - 1;
    }

    static int nearestJoint(double x, double y) {
        int nearest = 0;
        for (int j = 0; j < 12; ++j)
            if (j != kHead && j != kSlot &&
                std::hypot(x - kJoints[j].x, y - kJoints[j].y) <
                    std::hypot(x - kJoints[nearest].x, y - kJoints[nearest].y))
                nearest = j;
        return nearest;
    }

    /// The closed surface of the grid cells that a body fills.
    void addBody() {
        constexpr double cell = 0.1;
        const auto inside = [](int x, int y, int z) {
            if (z < -1 || z > 0 || y < 0) return false;
            const bool trunk = y < 15 && x >= -3 && x < 3,
                       arms = y >= 12 && y < 14 && x >= -18 && x < 18;
            const bool neck = y < 17 && x >= -1 && x < 1;
            return trunk || arms || neck;
        };
        std::map<std::tuple<int, int, int>, std::size_t> known;
        const auto at = [&](int x, int y, int z) {
            const auto [entry, isNew] = known.emplace(std::make_tuple(x, y, z), 0);
            if (isNew)
                entry->second =
                    vertex(cell * x, cell * y, cell * z, nearestJoint(cell * x, cell * y));
            return double(entry->second);
        };
        for (int x = -18; x < 18; ++x)
            for (int y = 0; y < 17; ++y)
                for (int z = -1; z < 1; ++z) {
                    if (!inside(x, y, z)) continue;
                    for (int axis = 0; axis < 3; ++axis)
                        for (int side = 0; side < 2; ++side) {
                            const int step = 2 * side - 1;
                            if (inside(x + (axis == 0 ? step : 0), y + (axis == 1 ? step : 0),
                                       z + (axis == 2 ? step : 0)))
                                continue;
                            double quad[4];
                            for (int c = 0; c < 4; ++c) {
                                const int u = c == 1 || c == 2, v = c >= 2;
                                int p[3] = {x, y, z};
                                p[axis] += side;
                                p[(axis + 1) % 3] += u;
                                p[(axis + 2) % 3] += v;
                                quad[c] = at(p[0], p[1], p[2]);
                            }
                            if (side == 0) std::swap(quad[1], quad[3]);
                            indices.insert(indices.end(),
                                           {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
                        }
                }
    }

    /// A tube of nine rings of four vertices, from the head upwards.
    void addPlume() {
        const std::size_t first = places.size() / 3;
        for (int ring = 0; ring < 9; ++ring)
            for (const double side : {-0.05, 0.05})
                for (const double deep : {-side, side})
                    vertex(side, 2.95 + 0.2 * ring, deep, 12 + std::min(ring / 2, 3));
        const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
            for (const std::size_t corner : {a, b, c, a, c, d})
                indices.push_back(double(first + corner));
        };
        for (std::size_t ring = 0; ring < 8; ++ring)
            for (std::size_t k = 0; k < 4; ++k)
                quad(4 * ring + k, 4 * ring + 4 + k, 4 * ring + 4 + (k + 1) % 4,
                     4 * ring + (k + 1) % 4);
        quad(0, 1, 2, 3);
        quad(35, 34, 33, 32);
    }

    std::size_t addBox(double left, double right, double low, double high, double deep, int joint) {
        const std::size_t first = places.size() / 3;
        for (int c = 0; c < 8; ++c)
            vertex(c & 1 ? right : left, c & 2 ? high : low, c & 4 ? deep : -deep, joint);
        for (const int corner : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
            indices.push_back(double(first) + corner);
        return first;
    }
};

/// The largest distance of a box from its joint's rigid motion, over the clip.
double boxError(Character& character, const std::string& file, std::size_t first) {
    test::GltfReference reference(file);
    double most = 0.0;
    for (const double seconds : {0.1, 0.5, 0.9}) {
        character.poseAt(character.motions.front(), seconds);
        const std::vector<glm::dvec3> expected = reference.verticesAt(0, seconds);
        test::forEachCopy(character, [&](std::uint32_t v, const osg::Vec3d& p) {
            if (v >= first && v < first + 8)
                most = std::max(most, glm::length(glm::dvec3(p.x(), p.y(), p.z()) - expected[v]));
        });
    }
    return most;
}

/// The joint that all of a box's vertices follow, and no descendant of it; empty if they differ.
std::string jointOfBox(const Character& character, std::size_t first, std::size_t count = 8) {
    const osgSkin::Binding& binding = character.binding;
    std::uint32_t joint = 0;
    for (std::size_t v = first; v < first + count; ++v) {
        const std::uint32_t last = binding.influences[binding.firstInfluence[v + 1] - 1].joint;
        if (v > first && last != joint) return "";
        joint = last;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].bend != 1.0f || binding.influences[i].twist != 1.0f)
                return "";
    }
    return binding.joints[joint].name;
}

} // namespace

TEST(HeldThings, FollowTheJointTheyArePaintedFor) {
    Fighter fighter(true);
    const std::string file = fighter.save("fighter.gltf");
    for (const auto method :
         {osgSkin::LoadOptions::Method::Smooth, osgSkin::LoadOptions::Method::Weights}) {
        osgSkin::LoadOptions options;
        options.method = method;
        Character character = osgSkin::loadCharacter(file, options);
        EXPECT_LT(boxError(character, file, fighter.sword), 1e-5);
        EXPECT_LT(boxError(character, file, fighter.head), 1e-5);
        EXPECT_EQ(jointOfBox(character, fighter.sword), "slot.r");
        EXPECT_EQ(jointOfBox(character, fighter.head), "head");
    }
}

TEST(HeldThings, UnpaintedShellOfAHeadFollowsTheHead) {
    Fighter painted(true);
    painted.save("fighter_rig.gltf");
    for (const bool isExploded : {false, true}) {
        Fighter bare(false, isExploded);
        bare.json.erase("animations");
        bare.save("fighter_mesh.gltf");
        const std::string file = test::saveSkin(testing::TempDir() + "fighter.skin", {},
                                                "fighter_mesh.gltf", "fighter_rig.gltf");
        const Character character = osgSkin::loadCharacter(file);
        EXPECT_TRUE(character.body.weights.empty());
        EXPECT_EQ(jointOfBox(character, bare.head, isExploded ? 36 : 8), "head") << isExploded;
        const std::string said = character.bindReport.text();
        test::expectContains(said, "note: 1 shells follow one joint");
    }
}

/// Such as a tail of hair: what has joints of its own is no rigid part of the head.
TEST(HeldThings, ShellWithAChainOfItsOwnFollowsTheChain) {
    Fighter painted(true, false, true);
    painted.save("plumed_rig.gltf");
    Fighter bare(false, false, true);
    bare.json.erase("animations");
    bare.save("plumed_mesh.gltf");
    const Character character = osgSkin::loadCharacter(test::saveSkin(
        testing::TempDir() + "plumed.skin", {}, "plumed_mesh.gltf", "plumed_rig.gltf"));
    const std::size_t last = character.body.mesh.positions.size() - 1; // at the top
    EXPECT_EQ(character.binding.joints[character.binding.regions[last]].name, "plume4");
    EXPECT_EQ(character.binding.joints[character.binding.regions[last - 16]].name, "plume2");
}
