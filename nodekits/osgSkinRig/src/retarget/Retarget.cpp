// SPDX-License-Identifier: MIT
#include <osgSkinRig/Retarget>

#include "reference/CopyRotations.h"
#include "reference/StandingCheck.h"
#include "reference/StandingPose.h"
#include "retarget/Alignment.h"
#include "retarget/DrivenRig.h"
#include "retarget/FootRoll.h"
#include "retarget/JointPairs.h"
#include "retarget/MeasureFeet.h"
#include "retarget/RetargetNotes.h"
#include "retarget/RootMotion.h"
#include "retarget/UprightFrames.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

double degrees(const glm::dquat& q) {
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), std::abs(q.w)));
}

/// More than any foot is off its like in another body.
constexpr double kBackwards = 120.0;

/// Whether the feet of one skeleton point to where the other's do not.
bool doFeetDisagree(const BodyParts& parts, const std::vector<glm::dquat>& alignment) {
    return !parts.ankles.empty() &&
           std::all_of(parts.ankles.begin(), parts.ankles.end(), [&](int ankle) {
               return degrees(alignment[static_cast<std::size_t>(ankle)]) > kBackwards;
           });
}

void fillReport(RetargetReport& report, const Motion& motion, const RestSkeleton& rig,
                const std::vector<int>& motionJoint, const std::vector<glm::dquat>& alignment) {
    report.entries.clear();
    report.unusedMotionJoints.clear();
    std::vector<bool> used(motion.skeleton.joints.size(), false);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        RetargetReport::Entry entry{rig.joints[j].name, {}, 0.0, 0};
        if (motionJoint[j] >= 0) {
            const auto m = static_cast<std::size_t>(motionJoint[j]);
            used[m] = true;
            entry.motionJoint = motion.skeleton.joints[m].name;
            entry.alignmentDegrees = degrees(alignment[j]);
        }
        report.entries.push_back(entry);
    }
    for (std::size_t m = 0; m < used.size(); ++m)
        if (!used[m]) report.unusedMotionJoints.push_back(motion.skeleton.joints[m].name);
}

/// World orientations of the rig's joints from the motion's.
void driveRig(const RestSkeleton& rig, const std::vector<int>& motionJoint,
              const std::vector<glm::dquat>& alignment, const std::vector<glm::dquat>& motionWorld,
              std::vector<glm::dquat>& world) {
    world.resize(rig.joints.size());
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = rig.joints[j].parent;
        if (motionJoint[j] >= 0)
            world[j] = motionWorld[static_cast<std::size_t>(motionJoint[j])] * alignment[j];
        else // at rest on its parent
            world[j] = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                  : world[static_cast<std::size_t>(parent)];
    }
}

/// The rotations as they are in the space that `back` leads to.
void changeSpace(const glm::dquat& back, std::vector<glm::dquat>& rotations) {
    if (isIdentity(back)) return; // to the last bit
    for (glm::dquat& q : rotations) q = glm::normalize(back * q * glm::conjugate(back));
}

void addLocal(const RestSkeleton& rig, const std::vector<glm::dquat>& world, Clip& clip) {
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = rig.joints[j].parent;
        clip.rotations.push_back(glm::normalize(
            parent < 0 ? world[j]
                       : glm::conjugate(world[static_cast<std::size_t>(parent)]) * world[j]));
    }
}

/// The rotations go over as they are: nothing is aligned, nor set on a floor.
Clip copied(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
            const SameSkeleton& same, RetargetReport* report) {
    glm::dvec3 offset;
    Clip clip = copyRotations(motion, rig, map.motionJoint, same, offset);
    if (report != nullptr) {
        fillReport(*report, motion, rig, map.motionJoint,
                   std::vector<glm::dquat>(clip.joints, {1.0, 0.0, 0.0, 0.0}));
        report->scale = same.scale;
        report->rotation = {1.0, 0.0, 0.0, 0.0};
        report->offset = offset;
        report->feet.clear();
        report->notes.clear();
    }
    return clip;
}

/// \param motion counted from a pose in which the actor stands
Clip aligned(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
             RetargetReport* report) {
    const std::vector<int>& motionJoint = map.motionJoint;
    const UprightFrames frames =
        findUprightFrames(SkeletonTree(rig), SkeletonTree(motion.skeleton), map);
    const RestSkeleton uprightRig = rotated(rig, frames.rigUpright);
    const RestSkeleton uprightMotion = rotated(motion.skeleton, frames.motionUpright);
    const DrivenRig body(uprightRig, uprightMotion, map);
    const std::vector<glm::dquat> alignment = alignBones(body);
    const glm::dquat back = glm::conjugate(frames.rigUpright);

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    clip.rotations.reserve(clip.frames * clip.joints);

    FootRoll feetRoll(body, alignment);
    RootMotion root(body);
    MeasureFeet feet(body);
    StandingCheck standing(map.rig, map.motion);
    std::vector<glm::dquat> motionWorld;
    std::vector<glm::dquat> world;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        changeSpace(frames.motionUpright, motionWorld);
        driveRig(rig, motionJoint, alignment, motionWorld, world);
        feetRoll.straighten(world);
        root.add(frames.motionUpright * motion.rootPositions[f], motionWorld, world);
        feet.add({root.rigPositions(), world}, {root.motionPositions(), motionWorld});
        standing.add(root.rigPositions(), root.motionPositions());
        changeSpace(back, world);
        addLocal(rig, world, clip);
    }
    standing.finish();
    clip.rootPositions = root.finish();
    for (glm::dvec3& position : clip.rootPositions) position = back * position;

    if (report != nullptr) {
        fillReport(*report, motion, rig, motionJoint, alignment);
        for (std::size_t j = 0; j < clip.joints; ++j)
            report->entries[j].rolledOver = feetRoll.rolledOver(j);
        report->notes.clear();
        if (doFeetDisagree(body.rigParts, alignment))
            report->notes.emplace_back("the rig's feet point backwards where the actor's do not, "
                                       "or the reverse: one has left and right exchanged, or is "
                                       "mirrored");
        if (root.movedToOrigin())
            report->notes.emplace_back("the motion begins far from the origin: it starts at the "
                                       "origin here");
        report->scale = root.scale();
        report->rotation = back * frames.motionUpright;
        report->offset = back * root.offset();
        report->feet = feet.finish(motion.frameTime, root.scale());
    }
    return clip;
}

} // namespace

Clip retarget(const Motion& motion, const RestSkeleton& rig, const RetargetOptions& options,
              RetargetReport* report) {
    rig.validate();
    motion.validate();
    const JointPairs map = mapJoints(rig, motion.skeleton, options);
    const StandingPose pose = findStandingPose(motion, rig, map.motionJoint, map.rig, map.motion);
    Clip clip = pose.copied ? copied(motion, rig, map, *pose.copied, report)
                            : aligned(pose.counted ? *pose.counted : motion, rig, map, report);
    for (std::size_t f = 0; f < clip.frames; ++f)
        if (!isInRange(clip.rootPositions[f]))
            throw Error("retarget: frame " + std::to_string(f) +
                        ": the root's position is not finite, or beyond -1e18 to 1e18");
    if (report != nullptr) {
        report->notes.insert(report->notes.begin(), pose.notes.begin(), pose.notes.end());
        for (std::string& note : notesOf(map, rig, motion.skeleton, options))
            report->notes.push_back(std::move(note));
        report->rigNames = map.rig.family;
        report->motionNames = map.motion.family;
    }
    return clip;
}

} // namespace osgSkin
