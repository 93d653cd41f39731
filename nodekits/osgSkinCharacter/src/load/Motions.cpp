// SPDX-License-Identifier: MIT
#include "load/LoadSteps.h"
#include "source/LoadReport.h"

#include <osgSkinBind/RigidJoints>
#include <osgSkinImport/ImportMotion>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>

#include <osg/Quat>
#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace osgSkin {
namespace {

/// A clip has a rotation of every joint of the rig in every frame, however many joints the motion
/// has.
void checkSize(CharacterSource& source, const SkinFile::MotionEntry& entry, const Motion& motion) {
    const std::size_t joints = std::max(source.rest.joints.size(), motion.skeleton.joints.size());
    source.samples.add(entry.file, motion.frames + entry.skipFrames, joints, source.limits);
}

} // namespace

std::vector<CharacterMotion>
retargetMotions(CharacterSource& source, const osgDB::Options* readOptions, LoadStages& stages) {
    std::vector<CharacterMotion> motions;
    for (const SkinFile::MotionEntry& entry : source.motions) {
        stages.begin("motion " + entry.name, LoadStages::kMotion);
        CharacterMotion& made = motions.emplace_back();
        const auto make = [&] {
            Motion motion = importMotion(entry.file, entry.skipFrames, entry.clip, readOptions);
            checkSize(source, entry, motion);
            motion.name = entry.name;
            motion.yIsUp = motion.yIsUp || source.yIsUp;
            RetargetOptions options;
            options.joints = entry.joints;
            options.names = source.bind.names;
            options.up = entry.up;
            made.clip = retarget(motion, source.rest, options, &made.report);
        };
        withFileContext(source.file, [&] { withFileContext(entry.file, make); });
        OSG_INFO << entry.file << ":\n" << made.report.text();
        for (const std::string& note : made.report.notes)
            warn(source.notes, entry.file + ": " + note);
    }
    return motions;
}

void animateMotions(const CharacterSource& source, const Binding& binding,
                    std::vector<CharacterMotion>& motions) {
    const bool clears = source.options.avoidBody.value_or(false);
    for (std::size_t m = 0; m < motions.size(); ++m) {
        CharacterMotion& motion = motions[m];
        const std::string& file = source.motions[m].file;
        withFileContext(file, [&] {
            if (clears)
                motion.cleared = avoidBody(motion.clip, source.rest,
                                           recogniseJoints(source.rest, source.bind.names),
                                           source.body.mesh, binding);
            motion.animation = makeAnimation(motion.clip, source.rest);
        });
        if (clears) OSG_INFO << file << ": " << motion.cleared.text() << "\n";
    }
}

namespace {

/// Cosine of half a degree: a joint counts as moved where it rotates from rest by more than one
/// degree.
const double kStillCosine = std::cos(0.5 * 3.14159265358979 / 180.0);

void addMoved(const Clip& clip, std::vector<bool>& isMoved) {
    for (std::size_t i = 0; i < clip.rotations.size(); ++i)
        if (std::abs(clip.rotations[i].w) < kStillCosine) isMoved[i % clip.joints] = true;
}

/// A rigged model's clips have keys of all joints, moved or not.
void addMoved(const osgAnimation::Animation& animation, const std::map<std::string, int>& jointOf,
              std::vector<bool>& isMoved) {
    for (const auto& channel : animation.getChannels()) {
        const auto joint = jointOf.find(channel->getTargetName());
        const auto* turns =
            dynamic_cast<const osgAnimation::QuatSphericalLinearChannel*>(channel.get());
        if (joint == jointOf.end() || turns == nullptr || turns->getSamplerTyped() == nullptr)
            continue;
        const auto* keys = turns->getSamplerTyped()->getKeyframeContainerTyped();
        if (keys == nullptr || keys->empty()) continue;
        const osg::Quat first = keys->front().getValue();
        if (std::any_of(keys->begin(), keys->end(), [&first](const auto& key) {
                return std::abs(key.getValue().asVec4() * first.asVec4()) < kStillCosine;
            }))
            isMoved[static_cast<std::size_t>(joint->second)] = true;
    }
}

} // namespace

void setRigidParts(CharacterSource& source, const std::vector<CharacterMotion>& motions) {
    if (source.bind.rigid || (motions.empty() && source.animations.empty())) return;
    const RestSkeleton& rest = source.rest;
    const std::vector<std::string> stiff = automaticRigidJoints(rest, source.bind.names);
    std::vector<bool> isMoved(rest.joints.size(), false);
    const std::map<std::string, int> jointOf = rest.byName();
    for (const CharacterMotion& motion : motions) addMoved(motion.clip, isMoved);
    for (const auto& animation : source.animations) addMoved(*animation, jointOf, isMoved);
    source.bind.rigid = automaticRigidJoints(rest, source.bind.names, isMoved);
    std::string names;
    for (const std::string& name : *source.bind.rigid)
        if (std::find(stiff.begin(), stiff.end(), name) == stiff.end())
            names += (names.empty() ? "\"" : ", \"") + name + '"';
    if (!names.empty())
        source.rigidNote =
            "rigid parts that could bend, but no motion moves the joints below them: " + names;
}

} // namespace osgSkin
