// SPDX-License-Identifier: MIT
#include <osgSkinRig/Retarget>

#include "retarget/MakeReport.h"
#include "retarget/MotionSteps.h"
#include "retarget/PoseTransfer.h"
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>
#include <osgSkinRig/RetargetReport>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

namespace {

/// An empty clip of a rig for a motion.
Clip clipFor(const Motion& motion, const RestSkeleton& rig) {
    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    clip.rotations.resize(clip.frames * clip.joints);
    return clip;
}

/// Copies local rotations: nothing is aligned, nor put on the floor.
Clip copied(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
            const SameSkeleton& same, RetargetReport& report) {
    RotationCopy copy(motion.skeleton, rig, map.motionJoint, same);
    Clip clip = clipFor(motion, rig);
    for (std::size_t f = 0; f < motion.frames; ++f)
        clip.rootPositions.push_back(copy.pose(&motion.rotation(f, 0), motion.rootPositions[f],
                                               &clip.rotations[f * clip.joints]));
    reportCopied(copy, motion, rig, map, same.scale, report);
    return clip;
}

Clip aligned(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
             const StandingPose& pose, const RetargetOptions& options, RetargetReport& report) {
    PoseTransfer transfer(motion.skeleton, rig, map, pose);
    if (options.collarsFollow && !pose.isSame) transfer.followArms(motion);
    MeasureFeet feet(transfer.body());
    StandingCheck standing(map.rig, map.motion);
    Clip clip = clipFor(motion, rig);
    for (std::size_t f = 0; f < motion.frames; ++f) {
        transfer.drive(&motion.rotation(f, 0), motion.rootPositions[f]);
        transfer.addToPath();
        feet.add(transfer.rigPose(), transfer.motionPose());
        standing.add(transfer.rigPose().positions, transfer.motionPose().positions);
        transfer.getRotations(&clip.rotations[f * clip.joints]);
    }
    standing.finish();
    clip.rootPositions = transfer.root().finish();
    for (glm::dvec3& position : clip.rootPositions) position = transfer.back() * position;
    reportAligned(transfer, motion, rig, report);
    report.feet = feet.finish(motion.frameTime, report.scale);
    return clip;
}

/// The joints of a rig that is the motion's skeleton which the motion moves, by translations or by
/// turning a joint between theirs and their parent's.
std::vector<bool> movedJoints(const Motion& motion, const RestSkeleton& rig,
                              const std::vector<int>& motionJoint) {
    std::vector<bool> result(rig.joints.size(), false);
    for (std::size_t j = 1; j < result.size(); ++j) {
        const int driver = motionJoint[j];
        if (driver < 0) continue;
        const auto m = static_cast<std::size_t>(driver);
        const int above = motionJoint[static_cast<std::size_t>(rig.joints[j].parent)];
        result[j] =
            motion.moves.count(m) != 0 || (above >= 0 && motion.skeleton.joints[m].parent != above);
    }
    return result;
}

/// A joint's distance from its place at rest, over its bone's length, which is rounding.
constexpr double kNotMoved = 1e-5;

/// Moves the joints of a rig that is the motion's skeleton as the motion does.
/// \param isMoved see movedJoints()
/// \param report of the clip: where the motion's space is in the rig's
void addMoves(const Motion& motion, const RestSkeleton& rig, const std::vector<int>& motionJoint,
              const std::vector<bool>& isMoved, const RetargetReport& report, Clip& clip) {
    std::vector<glm::dquat> motionWorld, world;
    std::vector<glm::dvec3> theirs, ours;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        worldPositions(motion.skeleton, motionWorld, motion.rootPositions[f], motion.moves, f,
                       theirs);
        worldRotations(rig, &clip.rotations[f * clip.joints], world);
        ours.assign(clip.joints, clip.rootPositions[f]);
        for (std::size_t j = 1; j < clip.joints; ++j) {
            const auto p = static_cast<std::size_t>(rig.joints[j].parent);
            const int driver = motionJoint[j];
            glm::dvec3 offset = rig.joints[j].centre - rig.joints[p].centre;
            if (isMoved[j]) {
                const glm::dvec3 place =
                    report.scale * (report.rotation * theirs[static_cast<std::size_t>(driver)]) +
                    report.offset;
                offset = glm::conjugate(world[p]) * (place - ours[p]);
                clip.moves[j].push_back(offset);
            }
            ours[j] = ours[p] + world[p] * offset;
        }
    }
    for (std::size_t j = 1; j < clip.joints; ++j) { // those between which nothing turned
        if (!isMoved[j] || motion.moves.count(static_cast<std::size_t>(motionJoint[j])) != 0)
            continue;
        const RestJoint& joint = rig.joints[j];
        const glm::dvec3 offset =
            joint.centre - rig.joints[static_cast<std::size_t>(joint.parent)].centre;
        const std::vector<glm::dvec3>& offsets = clip.moves[j];
        if (std::all_of(offsets.begin(), offsets.end(), [&](const glm::dvec3& moved) {
                return glm::distance(moved, offset) <= kNotMoved * glm::length(offset);
            }))
            clip.moves.erase(j);
    }
}

} // namespace

Clip retarget(const Motion& motion, const RestSkeleton& rig, const RetargetOptions& options,
              RetargetReport* report) {
    rig.validate();
    motion.validate();
    const JointPairs map = mapJoints(rig, motion.skeleton, options);
    const StandingPose pose = findStandingPose(motion, rig, map, options.up);
    RetargetReport own;
    if (report == nullptr) report = &own;
    Clip clip = pose.copied ? copied(motion, rig, map, *pose.copied, *report)
                            : aligned(motion, rig, map, pose, options, *report);
    clip.morphs = motion.morphs;
    if (pose.isSame) {
        const std::vector<bool> isMoved = movedJoints(motion, rig, map.motionJoint);
        if (std::count(isMoved.begin(), isMoved.end(), true) > 0)
            addMoves(motion, rig, map.motionJoint, isMoved, *report, clip);
    }
    if (options.shareTwist && !pose.copied) {
        const std::vector<std::size_t> shared = HingeTwist(rig, map.rig).share(clip);
        for (std::size_t j = 0; j < shared.size(); ++j) report->entries[j].twistShared = shared[j];
    }
    for (std::size_t f = 0; f < clip.frames; ++f)
        if (!isInRange(clip.rootPositions[f]))
            throw Error("retarget: frame " + std::to_string(f) +
                        ": the root's position is not finite, or beyond -1e18 to 1e18");
    for (const auto& [joint, positions] : clip.moves)
        for (const glm::dvec3& position : positions)
            if (!isInRange(position))
                throw Error("retarget: joint \"" + rig.joints[joint].name +
                            "\" has a position that is not finite, or beyond -1e18 to 1e18");
    addNotes(pose, map, motion, rig, options, *report);
    return clip;
}

} // namespace osgSkin
