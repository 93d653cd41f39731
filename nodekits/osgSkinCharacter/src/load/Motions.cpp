// SPDX-License-Identifier: MIT
#include "load/LoadSteps.h"

#include "arms/BodyAvoider.h"
#include "source/LoadReport.h"

#include <osgSkinBind/RigidJoints>
#include <osgSkinImport/ImportMotion>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/BodyDirections>
#include <osgSkinRig/FaceNames>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <osg/Quat>
#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

/// A clip has a rotation of every joint of the rig in every frame, however many joints the motion
/// has.
void checkSize(CharacterSource& source, const SkinFile::MotionEntry& entry, const Motion& motion) {
    const std::size_t joints = std::max(source.rest.joints.size(), motion.skeleton.joints.size());
    source.samples.add(entry.file, motion.frames + entry.skipFrames, joints, source.limits);
}

/// Replaces the weights of a motion's expressions by those of the body's morph targets that move
/// its face so. Notes those that move none.
void matchMorphs(CharacterSource& source, const std::string& file, Clip& clip) {
    std::vector<std::string> names, own, lost;
    for (const auto& [name, weights] : clip.morphs) names.push_back(name);
    for (const MeshPart& part : source.body.parts)
        for (const MorphTarget& morph : part.morphs) own.push_back(morph.name);
    std::map<std::string, std::vector<float>> matched;
    for (const FaceMatch& match : matchFace(names, own)) {
        if (match.kind == FaceMatch::Kind::None) lost.push_back(match.name);
        const std::vector<float>& from = clip.morphs[match.name];
        for (const FaceMatch::Part& part : match.parts)
            for (const std::string& morph : part.morphs) { // of one target
                std::vector<float>& weights = matched[morph];
                weights.resize(clip.frames, 0.0f);
                for (std::size_t f = 0; f < clip.frames; ++f)
                    weights[f] = std::min(weights[f] + part.weight * from[f], 1.0f);
            }
    }
    clip.morphs = std::move(matched);
    if (!lost.empty())
        warn(source.notes, file + ": " + std::to_string(lost.size()) +
                               " expressions move no morph target of the body, \"" + lost.front() +
                               "\" among them");
}

/// Sets in every motion the morph targets that another moves, or else they would stay as that one
/// left them.
void completeMorphs(const CharacterSource& source, std::vector<CharacterMotion>& motions) {
    std::set<std::string> moved;
    for (const CharacterMotion& motion : motions)
        for (const auto& [morph, weights] : motion.clip.morphs) moved.insert(morph);
    for (const MeshPart& part : source.body.parts)
        for (const MorphTarget& morph : part.morphs)
            if (moved.count(morph.name) != 0)
                for (CharacterMotion& motion : motions)
                    motion.clip.morphs.try_emplace(morph.name, motion.clip.frames, morph.initial);
}

/// How far eyes turn that look 90 degrees away, as in most VRM files.
const double kEyeTurn = glm::radians(10.0);
constexpr const char* kLooks[] = {"lookLeft", "lookRight", "lookUp", "lookDown"};

/// Whether a clip says how the eyes look; one of the names alone is any expression's.
bool hasGaze(const Clip& clip) {
    return std::all_of(std::begin(kLooks), std::end(kLooks),
                       [&](const char* look) { return clip.morphs.count(look) != 0; });
}

/// Rotates the eyes as a motion looks, if the body has eyes.
void turnEyes(const CharacterSource& source, Clip& clip) {
    const JointRoles roles = recogniseJoints(source.rest, source.bind.names);
    std::vector<glm::dvec3> centres;
    for (const RestJoint& joint : source.rest.joints) centres.push_back(joint.centre);
    const BodyDirections body(roles, centres);
    const glm::dvec3 left = body.between("RightUpperLeg", "LeftUpperLeg");
    const glm::dvec3 trunk = body.between("Hips", "Head");
    const glm::dvec3 up = trunk - glm::dot(trunk, left) * left;
    bool any = false;
    for (const char* role : {"LeftEye", "RightEye"}) {
        const int eye = roles.joint(role);
        if (eye < 0 || !(glm::length(left) > 0.0) || !(glm::length(up) > 0.0)) continue;
        any = true;
        for (std::size_t f = 0; f < clip.frames; ++f) {
            const auto turn = [&](const char* plus, const char* minus) {
                return kEyeTurn * double(clip.morphs.at(plus)[f] - clip.morphs.at(minus)[f]);
            };
            clip.rotations[f * clip.joints + std::size_t(eye)] =
                glm::angleAxis(turn("lookLeft", "lookRight"), glm::normalize(up)) *
                glm::angleAxis(turn("lookDown", "lookUp"), left);
        }
    }
    for (const char* look : kLooks)
        if (any) clip.morphs.erase(look);
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
            if (hasGaze(made.clip)) turnEyes(source, made.clip);
            if (!made.clip.morphs.empty()) matchMorphs(source, entry.file, made.clip);
        };
        withFileContext(source.file, [&] { withFileContext(entry.file, make); });
        OSG_INFO << entry.file << ":\n" << made.report.text();
        for (const std::string& note : made.report.notes)
            warn(source.notes, entry.file + ": " + note);
    }
    completeMorphs(source, motions);
    return motions;
}

void animateMotions(const CharacterSource& source, const Binding& binding,
                    std::vector<CharacterMotion>& motions) {
    std::optional<BodyAvoider> avoider;
    if (source.options.avoidBody.value_or(false) && !motions.empty())
        avoider.emplace(source.rest, recogniseJoints(source.rest, source.bind.names),
                        source.body.mesh, binding);
    for (std::size_t m = 0; m < motions.size(); ++m) {
        CharacterMotion& motion = motions[m];
        const std::string& file = source.motions[m].file;
        withFileContext(file, [&] {
            if (avoider) motion.cleared = avoider->apply(motion.clip);
            motion.animation = makeAnimation(motion.clip, source.rest);
        });
        if (avoider) OSG_INFO << file << ": " << motion.cleared.text() << "\n";
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
