// SPDX-License-Identifier: MIT
#include "Alignment.h"
#include "BodyParts.h"
#include "JointMap.h"
#include "RootMotion.h"
#include "SkeletonTree.h"

#include <osgSkinImport/Retarget>

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

double degrees(const glm::dquat& q) {
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), std::abs(q.w)));
}

void fillReport(RetargetReport& report, const Motion& motion, const RestSkeleton& rig,
                const std::vector<int>& motionJoint, const std::vector<glm::dquat>& alignment) {
    report.entries.clear();
    report.unusedMotionJoints.clear();
    std::vector<bool> used(motion.skeleton.joints.size(), false);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        RetargetReport::Entry entry{rig.joints[j].name, {}, 0.0};
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
void turnRig(const RestSkeleton& rig, const std::vector<int>& motionJoint,
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

} // namespace

Clip retarget(const Motion& motion, const RestSkeleton& rig, const RetargetOptions& options,
              RetargetReport* report) {
    rig.validate();
    motion.skeleton.validate();
    const JointMap map = mapJoints(rig, motion.skeleton, options);
    const std::vector<int>& motionJoint = map.motionJoint;
    const SkeletonTree rigTree(rig);
    const SkeletonTree motionTree(motion.skeleton);
    const std::vector<glm::dquat> alignment = alignBones(rigTree, motionTree, motionJoint);

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    clip.rotations.reserve(clip.frames * clip.joints);

    RootMotion root(rigTree, motionTree, motionJoint);
    std::vector<glm::dquat> motionWorld;
    std::vector<glm::dquat> world;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        turnRig(rig, motionJoint, alignment, motionWorld, world);
        for (std::size_t j = 0; j < clip.joints; ++j) {
            const int parent = rig.joints[j].parent;
            clip.rotations.push_back(glm::normalize(
                parent < 0 ? world[j]
                           : glm::conjugate(world[static_cast<std::size_t>(parent)]) * world[j]));
        }
        root.add(motion.rootPositions[f], motionWorld, world);
    }
    clip.rootPositions = root.finish();

    if (report != nullptr) {
        fillReport(*report, motion, rig, motionJoint, alignment);
        report->rigNames = map.rig.family;
        report->motionNames = map.motion.family;
        report->scale = root.scale();
        report->offset = root.offset();
    }
    return clip;
}

} // namespace osgSkin
