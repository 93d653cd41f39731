// SPDX-License-Identifier: MIT
//
// Shells near a hand or a head stay attached to it when the skin is bound by regions.
//
// Motions that move hands into the body: the guard moves the hands out, and nothing else.
#include "ArmCuts.h"
#include "BlendError.h"
#include "CharacterFiles.h"
#include "Command.h"
#include "DrawnSkin.h"
#include "GltfBuilder.h"
#include "GltfReference.h"
#include "arms/BodySurface.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/AvoidBody>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>
#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
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

struct Fighter : GltfBuilder {
    std::vector<double> places, corners, indices;
    std::size_t sword = 0, head = 0; ///< their first vertices, 8 each
    std::vector<std::size_t> joints;

    explicit Fighter(bool painted, bool isExploded = false) {
        for (const Joint& joint : kJoints) {
            const double x = joint.parent < 0 ? 0.0 : kJoints[joint.parent].x;
            const double y = joint.parent < 0 ? 0.0 : kJoints[joint.parent].y;
            joints.push_back(
                node({{"name", joint.name}, {"translation", {joint.x - x, joint.y - y, 0}}}));
            if (joint.parent >= 0)
                json["nodes"][std::size_t(joint.parent)]["children"].push_back(joints.back());
        }
        addBody();
        sword = addBox(-1.75, -0.4, 1.36, 1.44, 0.05, kSlot);
        head = addBox(-0.35, 0.35, 1.42, 2.3, 0.3, kHead);
        if (isExploded) explode();
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
        for (const Joint& joint : kJoints)
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
                if (name == std::string(kJoints[j].name))
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

TEST(HeldThings, KeepTheJointThatTheyArePaintedFor) {
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

TEST(HeldThings, ABoxOfAHeadStaysWithTheHeadUnpainted) {
    Fighter painted(true);
    painted.save("fighter_rig.gltf");
    for (const bool isExploded : {false, true}) {
        Fighter bare(false, isExploded);
        bare.json.erase("animations");
        bare.save("fighter_mesh.gltf");
        const std::string file = testing::TempDir() + "fighter.skin";
        std::ofstream(file)
            << R"({"osgskin": 1, "mesh": "fighter_mesh.gltf", "skeleton": "fighter_rig.gltf"})";
        const Character character = osgSkin::loadCharacter(file);
        EXPECT_TRUE(character.body.weights.empty());
        EXPECT_EQ(jointOfBox(character, bare.head, isExploded ? 36 : 8), "head") << isExploded;
        const std::string said = character.bindReport.text();
        EXPECT_NE(said.find("note: 1 shells follow one joint"), std::string::npos) << said;
    }
}

using osgSkin::SkinPoints;

namespace {

/// Alternating points of two joints: of the first around (0, 0, 0) and (4, 0, 0), of the second
/// around the same positions 2 higher; a bump in the middle of each.
SkinPoints bumps() {
    SkinPoints points;
    for (int ring = 0; ring < 8; ++ring)
        for (const double x : {0.0, 4.0})
            for (const std::uint32_t joint : {0u, 1u}) {
                const double angle = 0.25 * M_PI * ring;
                const glm::dvec3 around(0.5 * std::cos(angle), 2.0 * joint, 0.5 * std::sin(angle));
                points.add(around + glm::dvec3(x, 0.4 * (ring % 2), 0), {0, 1, 0}, joint);
            }
    return points;
}

} // namespace

TEST(SkinPoints, AreAveragedOverAllThatMoveAlike) {
    const SkinPoints points = bumps();
    const SkinPoints averaged = points.averaged(4);
    ASSERT_EQ(averaged.size(), 4u);
    std::size_t of[2] = {0, 0};
    for (std::size_t k = 0; k < averaged.size(); ++k) {
        const std::uint32_t joint = averaged.joints[k];
        ++of[joint];
        const double x = averaged.places[k].x < 2.0 ? 0.0 : 4.0;
        EXPECT_LT(glm::distance(averaged.places[k], glm::dvec3(x, 2.0 * joint + 0.2, 0)), 1e-12)
            << k;
        EXPECT_NEAR(averaged.normals[k].y, 1.0, 1e-12);
    }
    EXPECT_EQ(of[0], 2u);
    EXPECT_EQ(of[1], 2u);
}

TEST(SkinPoints, AreAllKeptWhereThereAreFew) {
    const SkinPoints points = bumps();
    EXPECT_EQ(points.spread(points.size()).places, points.places);
    EXPECT_EQ(points.spread(5).size(), 5u);
}

namespace {

using osgSkin::Clip;
using test::CharacterCase;

constexpr double kTrunk = 0.16, kArm = 0.04; ///< radii

/// The rotation angle in degrees, at most 180.
double degreesOf(const glm::dquat& q) {
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), std::abs(q.w)));
}

/// A body of capsules without skin for the legs: a round trunk, and two arms that hang beside it.
struct RoundBody {
    osgSkin::RestSkeleton rest;
    osgSkin::SkinMesh mesh;
    osgSkin::Binding binding; ///< regions alone
    osgSkin::JointRoles roles;
    std::size_t upper = 0, lower = 0; ///< left

    /// \param apart distance of the shoulders from the trunk's axis
    explicit RoundBody(double apart = 0.26) {
        const int hips = add("Hips", -1, {0, 1, 0});
        const int spine = add("Spine", hips, {0, 1.2, 0});
        add("Head", add("Neck", spine, {0, 1.5, 0}), {0, 1.6, 0});
        for (const double side : {1.0, -1.0}) {
            const std::string name = side > 0.0 ? "Left" : "Right";
            const int leg = add(name + "UpLeg", hips, {0.1 * side, 0.9, 0});
            add(name + "Foot", add(name + "Leg", leg, {0.1 * side, 0.5, 0}), {0.1 * side, 0.1, 0});
            const int arm = add(name + "Arm", spine, {apart * side, 1.45, 0});
            const int forearm = add(name + "ForeArm", arm, {apart * side, 1.15, 0});
            const int hand = add(name + "Hand", forearm, {apart * side, 0.9, 0});
            tube(forearm, {apart * side, 1.13, 0}, 0.22, kArm);
            tube(hand, {apart * side, 0.9, 0}, 0.12, kArm);
            if (side < 0.0) continue;
            upper = std::size_t(arm);
            lower = std::size_t(forearm);
        }
        tube(spine, {0, 1.5, 0}, 0.7, kTrunk);
        roles = osgSkin::recogniseJoints(rest);
    }

    int add(const std::string& name, int parent, const glm::dvec3& centre) {
        return rest.add(name, parent, centre);
    }

    /// Adds a closed tube that points down.
    void tube(int joint, const glm::dvec3& top, double length, double radius) {
        constexpr std::uint32_t kAround = 16, kAlong = 12;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t h = 0; h <= kAlong; ++h)
            for (std::uint32_t a = 0; a < kAround; ++a) {
                const double angle = 2.0 * std::acos(-1.0) * a / kAround;
                mesh.positions.push_back(top + glm::dvec3(radius * std::sin(angle),
                                                          -length * h / kAlong,
                                                          radius * std::cos(angle)));
            }
        for (std::uint32_t h = 0; h < kAlong; ++h)
            for (std::uint32_t a = 0; a < kAround; ++a) {
                const std::uint32_t row = first + h * kAround, next = (a + 1) % kAround;
                face({row + a, row + kAround + a, row + kAround + next, row + next});
            }
        std::vector<std::uint32_t> lid, floor;
        for (std::uint32_t a = 0; a < kAround; ++a) {
            lid.push_back(first + a);
            floor.push_back(first + kAlong * kAround + kAround - 1 - a);
        }
        face(lid);
        face(floor);
        binding.regions.resize(mesh.positions.size(), static_cast<std::uint32_t>(joint));
    }

    void face(const std::vector<std::uint32_t>& corners) {
        mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
        mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
    }

    /// The left arm hangs, its elbow bent forwards; the upper arm rotates inwards by these degrees.
    Clip clip(const std::vector<double>& inwards) const {
        Clip clip;
        clip.frames = inwards.size();
        clip.joints = rest.joints.size();
        clip.frameTime = 1.0 / 60;
        clip.rotations.assign(clip.frames * clip.joints, {1, 0, 0, 0});
        clip.rootPositions.assign(clip.frames, rest.joints[0].centre);
        for (std::size_t f = 0; f < clip.frames; ++f) {
            clip.rotations[f * clip.joints + upper] =
                glm::angleAxis(glm::radians(-inwards[f]), glm::dvec3(0, 0, 1)) *
                glm::angleAxis(glm::radians(-8.0), glm::dvec3(1, 0, 0));
            clip.rotations[f * clip.joints + lower] =
                glm::angleAxis(glm::radians(-4.0), glm::dvec3(1, 0, 0));
        }
        return clip;
    }

    osgSkin::AvoidBodyReport clear(Clip& clip) const {
        return osgSkin::avoidBody(clip, rest, roles, mesh, binding);
    }

    /// How deep the left arm's skin is in the trunk, whose axis is y.
    double depth(const Clip& clip, std::size_t frame) const {
        std::vector<glm::dquat> world;
        std::vector<glm::dvec3> centres;
        osgSkin::worldRotations(rest, &clip.rotations[frame * clip.joints], world);
        osgSkin::worldPositions(rest, world, clip.rootPositions[frame], centres);
        double deepest = -1.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const std::uint32_t j = binding.regions[v];
            if (!rest.isInSubtree(int(j), int(lower))) continue;
            const glm::dvec3 p =
                centres[j] + world[j] * (mesh.positions[v] - rest.joints[j].centre);
            if (p.y < 0.8 || p.y > 1.5) continue;
            deepest = std::max(deepest, kTrunk - std::hypot(p.x, p.z));
        }
        return deepest;
    }
};

/// The left upper arm's rotation, by frame.
std::vector<double> turns(const RoundBody& body, const Clip& before, const Clip& after) {
    std::vector<double> result;
    for (std::size_t f = 0; f < before.frames; ++f) {
        const std::size_t at = f * before.joints + body.upper;
        result.push_back(degreesOf(after.rotations[at] * glm::conjugate(before.rotations[at])));
    }
    return result;
}

std::vector<double> sweep(double from, double to, std::size_t frames) {
    std::vector<double> result;
    for (std::size_t f = 0; f < frames; ++f)
        result.push_back(from + (to - from) * double(f) / double(frames - 1));
    return result;
}

} // namespace

TEST(AvoidBody, TakesAHandOutOfTheTrunk) {
    const RoundBody body;
    const Clip before = body.clip({18.0});
    ASSERT_GT(body.depth(before, 0), 0.02);
    Clip after = before;
    const osgSkin::AvoidBodyReport cleared = body.clear(after);
    EXPECT_LT(body.depth(after, 0), 0.004);
    EXPECT_GT(body.depth(after, 0), -0.015) << "farther than needed";
    EXPECT_EQ(cleared.turned, 1u);
    EXPECT_EQ(cleared.samples, 2u);
    EXPECT_GT(cleared.largestDegrees, 1.0);
    // Only that upper arm differs.
    for (std::size_t i = 0; i < before.rotations.size(); ++i)
        if (i != body.upper) {
            EXPECT_EQ(after.rotations[i], before.rotations[i]);
        }
}

TEST(AvoidBody, LeavesFreeArmsToTheBit) {
    const RoundBody body;
    const Clip before = body.clip(sweep(-60.0, 2.0, 40));
    Clip after = before;
    EXPECT_EQ(body.clear(after).turned, 0u);
    EXPECT_EQ(after.rotations, before.rotations);
}

TEST(AvoidBody, LeavesTheRestPoseAndItsContacts) {
    const RoundBody body(0.17); // forearms rest inside the trunk
    Clip before = body.clip({0.0});
    std::fill(before.rotations.begin(), before.rotations.end(), glm::dquat(1, 0, 0, 0));
    ASSERT_GT(body.depth(before, 0), 0.02);
    Clip after = before;
    EXPECT_EQ(body.clear(after).turned, 0u);
    EXPECT_EQ(after.rotations, before.rotations);
}

TEST(AvoidBody, TurnsNoFasterThanTheArmItself) {
    const RoundBody body;
    const std::vector<double> inwards = sweep(-5.0, 45.0, 126); // by 0.4 degrees a frame
    const Clip before = body.clip(inwards);
    Clip after = before;
    const osgSkin::AvoidBodyReport cleared = body.clear(after);
    const std::vector<double> added = turns(body, before, after);
    EXPECT_EQ(added.front(), 0.0);
    EXPECT_GT(*std::max_element(added.begin(), added.end()), 8.0);
    EXPECT_LE(cleared.largestDegrees, osgSkin::AvoidBodyReport::kMaxDegrees);
    double fastest = 0.0;
    for (std::size_t f = 1; f < added.size(); ++f)
        fastest = std::max(fastest, std::abs(added[f] - added[f - 1]));
    EXPECT_LT(fastest, 0.8);
}

TEST(AvoidBody, AWalkersHandsKeepOutOfAWideBody) {
    const CharacterCase* walk = nullptr;
    for (const CharacterCase& known : test::characterCases())
        if (std::string(known.name) == "neutral_walk") walk = &known;
    ASSERT_NE(walk, nullptr);
    std::string why;
    if (!test::isAvailable(*walk, why)) GTEST_SKIP() << why;
    osgSkin::Character character =
        osgSkin::loadCharacter(test::skinFile(*walk, test::makeTestFolder()));
    osgSkin::CharacterMotion before = character.motions.front();
    Clip thinned = before.clip; // every twentieth sample is enough
    thinned.frames = 0;
    thinned.frameTime *= 20.0;
    thinned.rotations.clear();
    thinned.rootPositions.clear();
    for (std::size_t f = 0; f < before.clip.frames; f += 20, ++thinned.frames) {
        const auto first = before.clip.rotations.begin() + std::ptrdiff_t(f * thinned.joints);
        thinned.rotations.insert(thinned.rotations.end(), first,
                                 first + std::ptrdiff_t(thinned.joints));
        thinned.rootPositions.push_back(before.clip.rootPositions[f]);
    }
    before.clip = thinned;
    osgSkin::CharacterMotion after = before;
    const osgSkin::AvoidBodyReport cleared =
        osgSkin::avoidBody(after.clip, character.rest, osgSkin::recogniseJoints(character.rest),
                           character.body.mesh, character.binding);
    test::ArmCuts cuts(character);
    std::size_t cutsBefore = 0, cutsAfter = 0;
    for (std::size_t f = 0; f < thinned.frames; ++f) {
        character.pose(before, f);
        cutsBefore += cuts.count();
        character.pose(after, f);
        cutsAfter += cuts.count();
    }
    EXPECT_GT(cutsBefore, 20 * thinned.frames); // the CMU actor's elbows on a wide body
    EXPECT_LT(double(cutsAfter), 0.15 * double(cutsBefore));
    EXPECT_LT(cleared.meanDegrees, 3.0);
    EXPECT_LE(cleared.largestDegrees, osgSkin::AvoidBodyReport::kMaxDegrees);
}

TEST(AvoidBody, FilesAndOptionsAskForIt) {
    const std::string folder = test::makeTestFolder();
    const std::string file = folder + "/clear.skin";
    std::ofstream(file) << R"({"osgskin": 1, "mesh": ")" OSGSKIN_DATA R"(/thrower.obj",
        "skeleton": ")" OSGSKIN_DATA R"(/thrower.bvh", "avoidBody": true,
        "motions": [{"file": ")" OSGSKIN_DATA R"(/throw.bvh"}]})";
    const osgSkin::Character asked = osgSkin::loadCharacter(file);
    EXPECT_EQ(asked.motions.front().cleared.samples, 2 * asked.motions.front().clip.frames);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("avoidBody=off");
    const osgSkin::Character forbidden =
        osgSkin::loadCharacter(file, osgSkin::toLoadOptions(options));
    EXPECT_EQ(forbidden.motions.front().cleared.samples, 0u);
    EXPECT_EQ(osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin").motions.front().cleared.samples,
              0u);
    EXPECT_THROW(osgSkin::toLoadOptions(new osgDB::Options("avoidBody=maybe")), osgSkin::Error);
}

TEST(AvoidBody, RefusesWhatDoesNotFit) {
    const RoundBody body;
    Clip clip = body.clip({0.0});
    clip.rotations.pop_back();
    EXPECT_THROW(body.clear(clip), osgSkin::Error);
    clip = body.clip({0.0});
    osgSkin::Binding other = body.binding;
    other.regions.back() = 1000;
    EXPECT_THROW(osgSkin::avoidBody(clip, body.rest, body.roles, body.mesh, other), osgSkin::Error);
}
