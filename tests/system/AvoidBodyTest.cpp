// SPDX-License-Identifier: MIT
// Motions that move hands into the body: avoidBody() moves the hands out, and nothing else.
#include "ArmCuts.h"
#include "CharacterFiles.h"
#include "Command.h"
#include "SkinFiles.h"
#include "WhyRefused.h"
#include "arms/BodySurface.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/AvoidBody>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

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

TEST(SkinPoints, AreAveragedByJoint) {
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

TEST(SkinPoints, AreKeptWhereThereAreFew) {
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

TEST(AvoidBody, KeepsAWalkersHandsOutOfAWideBody) {
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
