// SPDX-License-Identifier: MIT
#include <osgSkinRig/Retarget>

#include "retarget/Alignment.h"
#include "retarget/FootRoll.h"
#include "retarget/JointMap.h"
#include "retarget/MeasureFeet.h"
#include "retarget/RetargetNotes.h"
#include "retarget/RootMotion.h"
#include "retarget/UprightFrames.h"
#include "skeleton/SkeletonTree.h"

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

/// The turns as they are in the space that `back` leads to.
void turnSpace(const glm::dquat& back, std::vector<glm::dquat>& turns) {
    if (isIdentity(back)) return; // to the last bit
    for (glm::dquat& turn : turns) turn = glm::normalize(back * turn * glm::conjugate(back));
}

void addLocal(const RestSkeleton& rig, const std::vector<glm::dquat>& world, Clip& clip) {
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = rig.joints[j].parent;
        clip.rotations.push_back(glm::normalize(
            parent < 0 ? world[j]
                       : glm::conjugate(world[static_cast<std::size_t>(parent)]) * world[j]));
    }
}

} // namespace

Clip retarget(const Motion& motion, const RestSkeleton& rig, const RetargetOptions& options,
              RetargetReport* report) {
    rig.validate();
    motion.skeleton.validate();
    const JointMap map = mapJoints(rig, motion.skeleton, options);
    const std::vector<int>& motionJoint = map.motionJoint;
    const UprightFrames bearing =
        findBearing(SkeletonTree(rig), SkeletonTree(motion.skeleton), map);
    const RestSkeleton uprightRig = turned(rig, bearing.rigUpright);
    const RestSkeleton uprightMotion = turned(motion.skeleton, bearing.motionUpright);
    const SkeletonTree rigTree(uprightRig);
    const SkeletonTree motionTree(uprightMotion);
    const std::vector<glm::dquat> alignment = alignBones(rigTree, motionTree, motionJoint);
    const glm::dquat back = glm::conjugate(bearing.rigUpright);

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    clip.rotations.reserve(clip.frames * clip.joints);

    FootRoll feetRoll(rigTree, motionTree, motionJoint, alignment);
    RootMotion root(rigTree, motionTree, motionJoint);
    MeasureFeet feet(rigTree, motionTree, motionJoint);
    std::vector<glm::dquat> motionWorld;
    std::vector<glm::dquat> world;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        turnSpace(bearing.motionUpright, motionWorld);
        turnRig(rig, motionJoint, alignment, motionWorld, world);
        feetRoll.straighten(world);
        root.add(bearing.motionUpright * motion.rootPositions[f], motionWorld, world);
        feet.add({root.rigPlaces(), world}, {root.motionPlaces(), motionWorld});
        turnSpace(back, world);
        addLocal(rig, world, clip);
    }
    clip.rootPositions = root.finish();
    for (glm::dvec3& place : clip.rootPositions) place = back * place;

    if (report != nullptr) {
        fillReport(*report, motion, rig, motionJoint, alignment);
        for (std::size_t j = 0; j < clip.joints; ++j)
            report->entries[j].turnedOver = feetRoll.turnedOver(j);
        report->notes = notesOf(map, rig, motion.skeleton, options);
        report->rigNames = map.rig.family;
        report->motionNames = map.motion.family;
        report->scale = root.scale();
        report->turn = back * bearing.motionUpright;
        report->offset = back * root.offset();
        report->feet = feet.finish(motion.frameTime, root.scale());
    }
    return clip;
}

} // namespace osgSkin
