// SPDX-License-Identifier: MIT
#pragma once

#include "Figure.h"

#include <osgSkinRig/Retarget>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

/// Motions relative to other zero poses, and what becomes of them on a rig.

inline const glm::dquat kIdentity(1, 0, 0, 0);

/// The same movements, relative to another zero pose: `world` has the joints' rotations to it. With
/// `withFrames` the joints' frames rotate along, as in a file with its own axes.
inline osgSkin::Motion rebasedFrom(const osgSkin::Motion& motion,
                                   const std::vector<glm::dquat>& world, bool withFrames = false) {
    osgSkin::Motion result = motion;
    for (std::size_t j = 0; j < world.size(); ++j) {
        osgSkin::RestJoint& joint = result.skeleton.joints[j];
        const osgSkin::RestJoint& before = motion.skeleton.joints[j];
        if (joint.parent >= 0) {
            const auto p = std::size_t(joint.parent);
            joint.centre = result.skeleton.joints[p].centre +
                           world[p] * (before.centre - motion.skeleton.joints[p].centre);
        }
        if (joint.tip) joint.tip = joint.centre + world[j] * (*before.tip - before.centre);
        if (withFrames) joint.frame = world[j] * before.frame;
    }
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const Placed placed = place(motion, f);
        for (std::size_t j = 0; j < world.size(); ++j) {
            const int parent = motion.skeleton.joints[j].parent;
            const glm::dquat own = placed.turns[j] * glm::conjugate(world[j]);
            const glm::dquat above = parent < 0 ? kIdentity
                                                : placed.turns[std::size_t(parent)] *
                                                      glm::conjugate(world[std::size_t(parent)]);
            result.rotations[f * world.size() + j] = glm::normalize(glm::conjugate(above) * own);
        }
    }
    return result;
}

/// Every joint rotated differently: arms and legs point in any direction.
inline std::vector<glm::dquat> folded(std::size_t joints, unsigned seed = 7) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<glm::dquat> result;
    for (std::size_t j = 0; j < joints; ++j)
        result.push_back(glm::normalize(
            glm::dquat(normal(random), normal(random), normal(random), normal(random))));
    return result;
}

struct Difference {
    double limbs = 0.0;   ///< degrees between a limb of the rig and the actor's, the worst
    double heads = 0.0;   ///< the same from the hips to the head
    double lowest = 1e9;  ///< of the rig's ankles, above their height at rest
    double heading = 0.0; ///< degrees about +y between both bodies in the first sample
};

/// Compares the rig's motion with the actor's, who initially faces another direction.
inline Difference compare(const osgSkin::Clip& clip, const osgSkin::RestSkeleton& rig,
                          const osgSkin::Motion& actor) {
    static const char* const kBones[][2] = {
        {"LeftArm", "LeftForeArm"},    {"LeftForeArm", "LeftHand"}, {"RightArm", "RightForeArm"},
        {"RightForeArm", "RightHand"}, {"LeftUpLeg", "LeftLeg"},    {"LeftLeg", "LeftFoot"},
        {"RightUpLeg", "RightLeg"},    {"RightLeg", "RightFoot"},   {"Hips", "Head"}};
    const auto bone = [](const Placed& placed, const osgSkin::RestSkeleton& skeleton,
                         const char* from, const char* to) {
        return placed.places[std::size_t(skeleton.find(to))] -
               placed.places[std::size_t(skeleton.find(from))];
    };
    const auto heading = [&](const Placed& placed, const osgSkin::RestSkeleton& skeleton) {
        const glm::dvec3 left = bone(placed, skeleton, "RightUpLeg", "LeftUpLeg");
        return std::atan2(-left.z, left.x);
    };
    Difference result;
    glm::dquat turn = kIdentity;
    for (std::size_t f = 0; f < clip.frames; f += 3) {
        const Placed ours = place(clip, rig, f), theirs = place(actor, f);
        if (f == 0) {
            const double angle = heading(ours, rig) - heading(theirs, actor.skeleton);
            turn = glm::angleAxis(angle, glm::dvec3(0, 1, 0));
            result.heading = glm::degrees(std::abs(std::remainder(angle, 2.0 * M_PI)));
        }
        for (const auto& ends : kBones) {
            const double angle =
                angleBetween(bone(ours, rig, ends[0], ends[1]),
                             turn * bone(theirs, actor.skeleton, ends[0], ends[1]));
            double& worst = std::string(ends[1]) == "Head" ? result.heads : result.limbs;
            worst = std::max(worst, angle);
        }
        for (const char* ankle : {"LeftFoot", "RightFoot"}) {
            const auto j = std::size_t(rig.find(ankle));
            result.lowest = std::min(result.lowest, ours.places[j].y - rig.joints[j].centre.y);
        }
    }
    return result;
}

inline bool saysOf(const osgSkin::RetargetReport& report, const std::string& what) {
    return std::any_of(report.notes.begin(), report.notes.end(), [&](const std::string& note) {
        return note.find(what) != std::string::npos;
    });
}
