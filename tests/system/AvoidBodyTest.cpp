// SPDX-License-Identifier: MIT
// Motions that move arms into the body: avoidBody() moves them out, and nothing else.
#include "CharacterFiles.h"
#include "Command.h"
#include "SkinFiles.h"
#include "WhyRefused.h"
#include "arms/BodyFields.h"
#include "arms/SkinCuts.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/AvoidBody>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

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
    osgSkin::Binding binding; ///< rigid
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
        bindRigidly();
    }

    /// Each vertex follows its region's joint and all above it.
    void bindRigidly() {
        for (const osgSkin::RestJoint& joint : rest.joints)
            binding.joints.push_back(
                {joint.name, joint.parent, joint.centre, {0, -1, 0}, {0, -1, 0}});
        binding.firstInfluence.push_back(0);
        for (const std::uint32_t region : binding.regions) {
            for (std::uint32_t j = 0; j <= region; ++j)
                if (rest.isInSubtree(int(region), int(j)))
                    binding.influences.push_back({j, 1.0f, 1.0f});
            binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        }
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

    /// Both palms' positions in a sample.
    std::array<glm::dvec3, 2> hands(const Clip& clip, std::size_t frame) const {
        osgSkin::PosedJoints pose(rest);
        pose.set(rest, clip, frame);
        const auto hand = [&](const char* role) {
            const auto j = static_cast<std::size_t>(roles.joint(role));
            return pose.place(rest.joints[j].centre - glm::dvec3(0, 0.06, 0), j);
        };
        return {hand("LeftHand"), hand("RightHand")};
    }

    /// From the right palm to the left one, in sample 30.
    glm::dvec3 apart(const Clip& clip) const {
        const auto [left, right] = hands(clip, 30);
        return left - right;
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

TEST(AvoidBody, RotatesTheArmUntilTheHandIsOutsideTheTrunk) {
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

TEST(AvoidBody, DoesNotChangeFreeArms) {
    const RoundBody body;
    const Clip before = body.clip(sweep(-60.0, 2.0, 40));
    Clip after = before;
    EXPECT_EQ(body.clear(after).turned, 0u);
    EXPECT_EQ(after.rotations, before.rotations);
}

TEST(AvoidBody, DoesNotChangeFramesFarFromAnyCut) {
    const RoundBody body;
    std::vector<double> inwards(180, -10.0); // three seconds, with a cut in the middle
    for (std::size_t f = 84; f < 96; ++f)
        inwards[f] = -10.0 + 28.0 * std::sin(M_PI * double(f - 84) / 12.0);
    const Clip before = body.clip(inwards);
    Clip after = before;
    body.clear(after);
    const std::vector<double> added = turns(body, before, after);
    std::size_t first = added.size(), last = 0;
    for (std::size_t f = 0; f < added.size(); ++f)
        if (body.depth(before, f) > 0.0) {
            first = std::min(first, f);
            last = f;
        }
    ASSERT_LT(first, last);
    EXPECT_GT(added[90], 2.0);
    for (std::size_t f = 0; f < added.size(); ++f)
        if (f + 18 < first || f > last + 18) { // 0.3 seconds
            EXPECT_EQ(added[f], 0.0) << f;
        }
}

TEST(AvoidBody, KeepsTouchingHandsTogether) {
    const RoundBody body;
    Clip before = body.clip(std::vector<double>(60, 0.0));
    const auto right = static_cast<std::size_t>(body.roles.joint("RightUpperArm"));
    for (std::size_t f = 0; f < before.frames; ++f) {
        const double part = std::sin(M_PI * double(f) / double(before.frames - 1));
        const auto turn = [&](double inwards) {
            return glm::angleAxis(glm::radians(-16.0 * part), glm::dvec3(1, 0, 0)) *
                   glm::angleAxis(glm::radians(inwards * part), glm::dvec3(0, 0, 1));
        };
        before.rotations[f * before.joints + body.upper] = turn(-27.0);
        before.rotations[f * before.joints + right] = turn(27.0);
    }
    ASSERT_LT(glm::length(body.apart(before)), 0.08);
    ASSERT_GT(body.depth(before, 30), 0.01);
    Clip after = before;
    EXPECT_GT(body.clear(after).largestDegrees, 2.0);
    EXPECT_LT(glm::distance(body.apart(after), body.apart(before)), 0.02);
}

TEST(AvoidBody, DoesNotChangeContactsOfTheRestPose) {
    const RoundBody body(0.17); // forearms rest inside the trunk
    Clip before = body.clip({0.0});
    std::fill(before.rotations.begin(), before.rotations.end(), glm::dquat(1, 0, 0, 0));
    ASSERT_GT(body.depth(before, 0), 0.02);
    Clip after = before;
    EXPECT_EQ(body.clear(after).turned, 0u);
    EXPECT_EQ(after.rotations, before.rotations);
}

TEST(AvoidBody, RotatesNoFasterThanTheArm) {
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

TEST(AvoidBody, TurnsBothArmsWhereHandsTouchAndOneCuts) {
    const RoundBody body;
    Clip before = body.clip(std::vector<double>(60, 0.0));
    const auto right = static_cast<std::size_t>(body.roles.joint("RightUpperArm"));
    for (std::size_t f = 0; f < before.frames; ++f) { // only the left arm cuts the body
        const auto turn = [&](double forwards, double inwards) {
            return glm::angleAxis(glm::radians(-forwards), glm::dvec3(1, 0, 0)) *
                   glm::angleAxis(glm::radians(inwards), glm::dvec3(0, 0, 1));
        };
        before.rotations[f * before.joints + body.upper] = turn(32.0, -32.0);
        before.rotations[f * before.joints + right] = turn(40.0, 20.0);
    }
    ASSERT_LT(glm::length(body.apart(before)), 0.08);
    ASSERT_GT(body.depth(before, 30), 0.01);
    Clip after = before;
    EXPECT_GT(body.clear(after).largestDegrees, 2.0);
    EXPECT_LT(body.depth(after, 30), 0.004);
    EXPECT_LT(glm::distance(body.apart(after), body.apart(before)), 0.02);
}

TEST(AvoidBody, KeepsAWalkersHandsOutOfAWideBody) {
    const CharacterCase* walk = nullptr;
    for (const CharacterCase& known : test::characterCases())
        if (std::string(known.name) == "neutral_walk") walk = &known;
    ASSERT_NE(walk, nullptr);
    std::string why;
    if (!test::isAvailable(*walk, why)) GTEST_SKIP() << why;
    osgSkin::Character character =
        osgSkin::loadCharacter(test::skinFile(*walk, test::makeTestFolder()));
    const Clip& before = character.motions.front().clip;
    Clip after = before;
    const osgSkin::JointRoles roles = osgSkin::recogniseJoints(character.rest);
    const osgSkin::AvoidBodyReport cleared =
        osgSkin::avoidBody(after, character.rest, roles, character.body.mesh, character.binding);
    osgSkin::SkinCuts cuts(
        character.rest,
        osgSkin::BodyPieces(character.rest, roles, character.body.mesh, character.binding),
        character.body.mesh, character.binding);
    osgSkin::PosedJoints pose(character.rest);
    const auto count = [&](const Clip& clip) {
        std::size_t result = 0;
        for (std::size_t f = 0; f < clip.frames; f += 20) {
            pose.set(character.rest, clip, f);
            cuts.pose(pose);
            result += cuts.find(0).size() + cuts.find(1).size();
        }
        return result;
    };
    EXPECT_GT(count(before), before.frames); // the CMU actor's elbows on a wide body
    EXPECT_LT(double(count(after)), 0.05 * double(count(before)));
    EXPECT_LT(cleared.meanDegrees, 5.0);
    EXPECT_LT(cleared.largestDegrees, osgSkin::AvoidBodyReport::kMaxDegrees);
}

TEST(DistanceField, KnowsASphere) {
    osgSkin::VoxelGrid grid;
    grid.first = glm::dvec3(-1.5);
    grid.size = 0.1;
    grid.count = glm::ivec3(31);
    std::vector<char> inside;
    for (int z = 0; z < 31; ++z)
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 31; ++x)
                inside.push_back(glm::length(grid.first + 0.1 * glm::dvec3(x, y, z)) < 1.0 ? 1 : 0);
    const osgSkin::DistanceField field(grid, inside);
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    for (const double radius : {0.7, 0.9, 1.0, 1.3}) {
        const osgSkin::FieldSample found = field.at(radius * way);
        EXPECT_NEAR(found.distance, radius - 1.0, 0.05) << radius;
        EXPECT_GT(glm::dot(glm::normalize(found.outward), way), 0.95) << radius;
        // The gradient is that of the distance.
        const double step = 1e-5;
        EXPECT_NEAR((field.at((radius + step) * way).distance - found.distance) / step,
                    glm::dot(found.outward, way), 1e-3)
            << radius;
    }
    EXPECT_GT(osgSkin::DistanceField(grid, std::vector<char>(inside.size(), 0)).at(way).distance,
              1e30);
}

TEST(AvoidBody, IsSetByFilesAndOptions) {
    const std::string file = test::saveSkin(
        test::makeTestFolder() + "/clear.skin",
        R"(, "avoidBody": true, "motions": [{"file": ")" OSGSKIN_DATA R"(/throw.bvh"}])",
        OSGSKIN_DATA "/thrower.obj", OSGSKIN_DATA "/thrower.bvh");
    const osgSkin::Character asked = osgSkin::loadCharacter(file);
    EXPECT_EQ(asked.motions.front().cleared.samples, 2 * asked.motions.front().clip.frames);
    const osgSkin::Character forbidden =
        osgSkin::loadCharacter(file, test::loadOptions("avoidBody=off"));
    EXPECT_EQ(forbidden.motions.front().cleared.samples, 0u);
    EXPECT_EQ(osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin").motions.front().cleared.samples,
              0u);
    EXPECT_THROW(test::loadOptions("avoidBody=maybe"), osgSkin::Error);
}

TEST(AvoidBody, RejectsClipsAndBindingsOfOtherBodies) {
    const RoundBody body;
    Clip clip = body.clip({0.0});
    clip.rotations.pop_back();
    EXPECT_THROW(body.clear(clip), osgSkin::Error);
    clip = body.clip({0.0});
    osgSkin::Binding other = body.binding;
    other.regions.back() = 1000;
    EXPECT_THROW(osgSkin::avoidBody(clip, body.rest, body.roles, body.mesh, other), osgSkin::Error);
}
