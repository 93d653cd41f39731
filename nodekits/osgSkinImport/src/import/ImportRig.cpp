// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportRig>

#include "files/FileFormat.h"
#include "files/FileText.h"
#include "import/ShareScenes.h"
#include "mesh/FinishMesh.h"
#include "scene/ClipNames.h"
#include "scene/SceneMesh.h"
#include "scene/SceneSkeleton.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkin/UpdateMorphs>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinMotion/Constraint>

#include <glm/geometric.hpp>
#include <osgAnimation/Animation>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/Sampler>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

osg::ref_ptr<osgAnimation::Bone> makeBone(const std::string& name, const glm::dmat4& local,
                                          bool moves) {
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
    const osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
    osgAnimation::StackedTransform& stack = update->getStackedTransforms();
    if (moves) {
        const NodeTransform parts = decompose(local);
        stack.push_back(new osgAnimation::StackedTranslateElement(
            "translate", osg::Vec3(toOsg(parts.translation))));
        stack.push_back(
            new osgAnimation::StackedQuaternionElement("quaternion", toOsg(parts.rotation)));
        stack.push_back(
            new osgAnimation::StackedScaleElement("scale", osg::Vec3(toOsg(parts.scale))));
    } else {
        stack.push_back(new osgAnimation::StackedMatrixElement("matrix", toOsg(local)));
    }
    bone->setUpdateCallback(update);
    bone->setMatrix(toOsg(local));
    return bone;
}

/// Builds the bones of a scene's joints, in the pose of their nodes. Bones that clips move get the
/// elements "translate", "quaternion" and "scale"; other bones get a matrix element.
/// \param joints of the scene
/// \param moves whether some clip moves the joint, [joint]
osg::ref_ptr<osgAnimation::Skeleton> makeBones(const SceneSkeleton& joints,
                                               const std::vector<bool>& moves) {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setName("skeleton");
    skeleton->setUpdateCallback(new UpdatePlayedSkeleton);
    osg::Group* top = skeleton.get();
    if (joints.aboveRoot != glm::dmat4(1.0)) {
        const osg::ref_ptr<osgAnimation::Bone> above =
            makeBone(joints.rest.joints[0].name + kAboveRoot, joints.aboveRoot, false);
        above->setMatrixInSkeletonSpace(toOsg(joints.aboveRoot));
        skeleton->addChild(above);
        top = above.get();
    }
    std::vector<osgAnimation::Bone*> bones;
    std::vector<glm::dmat4> toScene;
    for (std::size_t j = 0; j < joints.nodes.size(); ++j) {
        const RestJoint& joint = joints.rest.joints[j];
        const glm::dmat4 local = joints.nodes[j]->matrix;
        const osg::ref_ptr<osgAnimation::Bone> bone = makeBone(joint.name, local, moves[j]);
        const auto parent = static_cast<std::size_t>(joint.parent);
        toScene.push_back((joint.parent < 0 ? joints.aboveRoot : toScene[parent]) * local);
        bone->setMatrixInSkeletonSpace(toOsg(toScene[j]));
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(toOsg(joints.bind[j])));
        (joint.parent < 0 ? top : bones[parent])->addChild(bone);
        bones.push_back(bone);
    }
    return skeleton;
}

using Tracks = std::unordered_map<std::string_view, const SourceTrack*>;

Tracks tracksOf(const SourceAnimation& animation) {
    Tracks result;
    for (const SourceTrack& track : animation.tracks) result.emplace(track.node, &track);
    return result;
}

bool isValid(const glm::dvec3& v) {
    return isInRange(v);
}

bool isValid(const glm::dquat& q) {
    const double length = glm::length(q);
    return std::isfinite(length) && length > 0.0;
}

bool isValid(float weight) {
    return std::isfinite(weight);
}

float stored(float weight) {
    return weight;
}

osg::Vec3 stored(const glm::dvec3& v) {
    return osg::Vec3(toOsg(v));
}

osg::Quat stored(const glm::dquat& q) {
    return toOsg(glm::normalize(q));
}

/// Converts a clip's ticks to seconds.
struct Clock {
    double first = std::numeric_limits<double>::infinity();
    double ticksPerSecond = 25.0;
    bool any = false; ///< whether there is any key

    double seconds(double ticks) const { return (ticks - first) / ticksPerSecond; }

    /// Ignores the time of a single key, which is constant: readers add such keys at 0.
    template <typename Keys>
    void include(const Keys& keys) {
        any = any || !keys.empty();
        if (keys.size() < 2) return;
        for (const auto& key : keys)
            if (std::isfinite(key.time)) first = std::min(first, key.time);
    }
};

/// Adds the channel of one stacked element or morph target: the track's keys, or a single key if it
/// has none.
/// \param target name of the callback that the channel moves
template <typename Channel, typename Keyframe, typename Keys, typename Value>
void addChannel(osgAnimation::Animation& animation, const std::string& target,
                const std::string& element, const Keys& keys, const Value& otherwise,
                const Clock& clock, const std::string& path) {
    const osg::ref_ptr<Channel> channel = new Channel;
    channel->setName(element);
    channel->setTargetName(target);
    auto* container = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    double last = -std::numeric_limits<double>::infinity();
    container->reserve(keys.size());
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const Value value(keys[k].value);
        if (!isValid(value) || !std::isfinite(keys[k].time))
            failFile(path, "animation " + inQuotes(animation.getName()) + ": joint " +
                               inQuotes(target) + ": key " + std::to_string(k) + " of its " +
                               element + " is not finite, or beyond -1e18 to 1e18");
        const double time = keys.size() > 1 ? clock.seconds(keys[k].time) : 0.0;
        if (!(time > last)) continue; // interpolation needs keys in order
        container->push_back(Keyframe(time, stored(value)));
        last = time;
    }
    if (container->empty()) container->push_back(Keyframe(0.0, stored(otherwise)));
    animation.getChannels().push_back(channel); // addChannel() would scan all other channels
}

/// Clamps scales of 0, which hide a part, so that the joint's matrix stays invertible.
osg::Vec3 clampedTinyScale(osg::Vec3 scale) {
    constexpr float kMinScale = 1e-5f;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(scale[axis]) < kMinScale) scale[axis] = std::copysign(kMinScale, scale[axis]);
    return scale;
}

void addJoint(osgAnimation::Animation& animation, const std::string& joint, const SourceNode& node,
              const SourceTrack* track, const Clock& clock, const std::string& path) {
    using namespace osgAnimation;
    const NodeTransform rest = decompose(node.matrix);
    static const SourceTrack none{};
    if (track == nullptr) track = &none;
    addChannel<Vec3LinearChannel, Vec3Keyframe>(animation, joint, "translate", track->positions,
                                                rest.translation, clock, path);
    addChannel<QuatSphericalLinearChannel, QuatKeyframe>(
        animation, joint, "quaternion", track->rotations, rest.rotation, clock, path);
    addChannel<Vec3LinearChannel, Vec3Keyframe>(animation, joint, "scale", track->scales,
                                                rest.scale, clock, path);
    auto* const scales = static_cast<Vec3LinearChannel&>(*animation.getChannels().back())
                             .getSamplerTyped()
                             ->getKeyframeContainerTyped();
    for (Vec3Keyframe& key : *scales) key.setValue(clampedTinyScale(key.getValue()));
}

/// The morph targets that some clip of a scene drives, with their initial weights.
using DrivenMorphs = std::map<std::string, float>;

DrivenMorphs drivenMorphs(const SourceScene& scene, const ImportedMesh& body) {
    DrivenMorphs all, result;
    for (const MeshPart& part : body.parts)
        for (const MorphTarget& target : part.morphs) all.emplace(target.name, target.initial);
    for (const auto& animation : scene.animations)
        for (const SourceMorphTrack& track : animation->morphs) {
            const auto known = all.find(track.morph);
            if (known == all.end()) continue;
            const auto isOther = [&](const auto& key) { return key.value != known->second; };
            if (std::any_of(track.weights.begin(), track.weights.end(), isOther))
                result.insert(*known);
        }
    return result;
}

using MorphTracks = std::map<std::string, const SourceMorphTrack*>;

/// The track of each driven morph target.
MorphTracks morphTracksOf(const SourceAnimation& animation, const DrivenMorphs& driven) {
    MorphTracks result;
    for (const SourceMorphTrack& track : animation.morphs)
        if (driven.count(track.morph) != 0) result.emplace(track.morph, &track);
    return result;
}

osg::ref_ptr<osgAnimation::Animation> makeClip(const SourceAnimation& source,
                                               const std::string& name, const SceneSkeleton& joints,
                                               const std::vector<bool>& moves,
                                               const DrivenMorphs& driven,
                                               const MorphTracks& morphs, const std::string& path) {
    const Tracks tracks = tracksOf(source);
    const auto trackOf = [&](std::size_t joint) -> const SourceTrack* {
        const auto found = tracks.find(joints.rest.joints[joint].name);
        return found == tracks.end() ? nullptr : found->second;
    };
    Clock clock;
    clock.ticksPerSecond = source.ticksPerSecond;
    for (std::size_t j = 0; j < moves.size(); ++j)
        if (const SourceTrack* track = trackOf(j)) {
            clock.include(track->positions);
            clock.include(track->rotations);
            clock.include(track->scales);
        }
    for (const auto& [morph, track] : morphs) clock.include(track->weights);
    if (!clock.any) return nullptr;
    if (!std::isfinite(clock.first)) clock.first = 0.0; // a pose
    osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->setName(name);
    clip->setPlayMode(osgAnimation::Animation::LOOP);
    for (std::size_t j = 0; j < moves.size(); ++j)
        if (moves[j])
            addJoint(*clip, joints.rest.joints[j].name, *joints.nodes[j], trackOf(j), clock, path);
    for (const auto& [morph, initial] : driven) {
        const auto found = morphs.find(morph);
        const SourceMorphTrack none;
        const SourceMorphTrack& track = found == morphs.end() ? none : *found->second;
        addChannel<osgAnimation::FloatLinearChannel, osgAnimation::FloatKeyframe>(
            *clip, UpdateMorphs::kName, morph, track.weights, initial, clock, path);
    }
    clip->computeDuration();
    return clip;
}

/// For each joint, whether some clip of the scene moves it.
std::vector<bool> movedJoints(const SourceScene& scene, const SceneSkeleton& joints) {
    std::vector<bool> moves(joints.nodes.size(), false);
    for (const auto& animation : scene.animations) {
        const Tracks tracks = tracksOf(*animation);
        for (std::size_t j = 0; j < moves.size(); ++j)
            moves[j] = moves[j] || tracks.count(joints.rest.joints[j].name) != 0;
    }
    return moves;
}

/// The scene's clips for the bones of makeBones() and the body's morph targets, without clips that
/// move none of them.
/// \throw osgSkin::Error if a key is not finite
osgAnimation::AnimationList makeClips(const SourceScene& scene, const SceneSkeleton& joints,
                                      const std::vector<bool>& moves, const ImportedMesh& body,
                                      std::size_t maxSamples, const std::string& path) {
    const DrivenMorphs driven = drivenMorphs(scene, body);
    const std::size_t moved =
        static_cast<std::size_t>(std::count(moves.begin(), moves.end(), true)) + driven.size();
    // Every clip has channels for all joints and morph targets that any clip moves.
    if (moved * scene.animations.size() > maxSamples / 8)
        failFile(path, std::to_string(scene.animations.size()) + " animations of " +
                           std::to_string(moved) + " joints and morph targets, expected at most " +
                           std::to_string(maxSamples / 8) + " tracks (option maxSamples)");
    osgAnimation::AnimationList result;
    const std::vector<std::string> names = clipNames(scene);
    std::vector<std::string> still;
    for (std::size_t a = 0; a < scene.animations.size(); ++a) {
        const MorphTracks morphs = morphTracksOf(*scene.animations[a], driven);
        if (const auto clip =
                makeClip(*scene.animations[a], names[a], joints, moves, driven, morphs, path))
            result.push_back(clip);
        else if (!scene.animations[a]->tracks.empty())
            still.push_back(names[a]);
    }
    if (!still.empty())
        warn(path, std::to_string(still.size()) +
                       " clips move no joint and no morph target, and are left out, " +
                       inQuotes(still.front()) + " among them");
    return result;
}

bool isRigged(const SourceScene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const auto& mesh) { return !mesh->bones.empty(); });
}

/// Says that a file may have bones that Assimp does not read.
std::string formatHint(const std::string& path) {
    return formatOf(path).extension == "iqm"
               ? "; Assimp reads no bones of .iqm files: export glTF or FBX"
               : "";
}

/// How to use a file that has motions only.
std::string motionHint(const std::string& path) {
    return "; its motions can move one: name it in the \"motions\" of a .skin file, or load the "
           "character with -O 'motion=\"" +
           path + "\"'";
}

} // namespace

bool hasImporter(const std::string& path) {
    return formatOf(path).reader < FileFormat::Osg;
}

ImportedRig importRig(const std::string& path, const osgDB::Options* options) try {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const std::string none = "no mesh with bones, expected a rigged character";
    const FileFormat format = formatOf(path);
    if (!format.hasSkeleton && format.hasMesh)
        refuse(path, limits, none + "; a .skin file can name a skeleton for it, or fit one");
    if (format.reader == FileFormat::Bvh) refuse(path, limits, none + motionHint(path));
    std::shared_ptr<const SourceScene> source = readSourceScene(path, options);
    if (!isRigged(*source)) {
        const auto face = std::make_shared<SourceScene>(*source);
        if (!bindFace(*face))
            failFile(path,
                     none + (source->animations.empty() ? formatHint(path) : motionHint(path)));
        source = face;
    }
    const SourceScene& scene = *source;

    ImportedRig result;
    CornerMesh body = readSceneMesh(scene, path, options);
    checkMaterials(body, path, limits);
    result.body = finishMesh(std::move(body), path, limits);
    const SceneSkeleton joints = readSceneSkeleton(scene, path, limits);
    result.rest = joints.rest;
    const std::vector<bool> moves = movedJoints(scene, joints);
    result.skeleton = makeBones(joints, moves);
    result.animations =
        makeClips(scene, joints, moves, result.body, limits.samplesOf(scene.bytes), path);
    result.toWorld = scene.toWorld;
    result.metresPerUnit = scene.metresPerUnit;
    return result;
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

} // namespace osgSkin
