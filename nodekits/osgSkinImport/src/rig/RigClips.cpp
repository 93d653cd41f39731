// SPDX-License-Identifier: MIT
#include "rig/RigClips.h"

#include "assimp/AssimpScene.h"
#include "rig/ClipNames.h"
#include "rig/RigBones.h"
#include "text/FileText.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>

#include <osgAnimation/Channel>
#include <osgAnimation/Sampler>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

using Tracks = std::map<std::string, const aiNodeAnim*>;

Tracks tracksOf(const aiAnimation& animation) {
    Tracks result;
    for (unsigned c = 0; c < animation.mNumChannels; ++c)
        result.emplace(animation.mChannels[c]->mNodeName.C_Str(), animation.mChannels[c]);
    return result;
}

bool isValid(const glm::dvec3& v) {
    return isInRange(v);
}

bool isValid(const glm::dquat& q) {
    const double length = glm::length(q);
    return std::isfinite(length) && length > 0.0;
}

osg::Vec3 stored(const glm::dvec3& v) {
    return osg::Vec3(toOsg(v));
}

osg::Quat stored(const glm::dquat& q) {
    return toOsg(glm::normalize(q));
}

/// The clip's time, from Assimp's ticks.
struct Clock {
    double first = std::numeric_limits<double>::infinity();
    double ticksPerSecond = 25.0;
    bool any = false; ///< key

    double seconds(double ticks) const { return (ticks - first) / ticksPerSecond; }

    /// A single key holds its value at all times, and Assimp adds some at 0.
    template <typename Key>
    void include(const Key* keys, unsigned count) {
        any = any || count > 0;
        for (unsigned k = 0; k < count && count > 1; ++k)
            if (std::isfinite(keys[k].mTime)) first = std::min(first, keys[k].mTime);
    }
};

/// One element's channel: the track's keys, or a single one where the track has none.
template <typename Channel, typename Keyframe, typename Key, typename Value>
void addChannel(osgAnimation::Animation& animation, const std::string& joint, const char* element,
                const Key* keys, unsigned count, const Value& otherwise, const Clock& clock,
                const std::string& path) {
    const osg::ref_ptr<Channel> channel = new Channel;
    channel->setName(element);
    channel->setTargetName(joint);
    auto* container = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    double last = -std::numeric_limits<double>::infinity();
    for (unsigned k = 0; k < count; ++k) {
        const Value value = toGlm(keys[k].mValue);
        if (!isValid(value) || !std::isfinite(keys[k].mTime))
            failFile(path, "animation " + inQuotes(animation.getName()) + ": joint " +
                               inQuotes(joint) + ": key " + std::to_string(k) + " of its " +
                               element + " is not finite, or beyond -1e18 to 1e18");
        const double time = count > 1 ? clock.seconds(keys[k].mTime) : 0.0;
        if (!(time > last)) continue; // interpolation needs keys in order
        container->push_back(Keyframe(time, stored(value)));
        last = time;
    }
    if (container->empty()) container->push_back(Keyframe(0.0, stored(otherwise)));
    animation.getChannels().push_back(channel); // addChannel() would look at all others again
}

/// What is hidden by a scale of 0 shrinks almost to a point: a joint's matrix has an inverse then.
osg::Vec3 clampedTinyScale(osg::Vec3 scale) {
    constexpr float kLeast = 1e-5f;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(scale[axis]) < kLeast) scale[axis] = std::copysign(kLeast, scale[axis]);
    return scale;
}

void addJoint(osgAnimation::Animation& animation, const std::string& joint, const aiNode& node,
              const aiNodeAnim* track, const Clock& clock, const std::string& path) {
    using namespace osgAnimation;
    const NodeTransform rest = decompose(toGlm(node.mTransformation));
    static const aiNodeAnim none;
    if (track == nullptr) track = &none;
    addChannel<Vec3LinearChannel, Vec3Keyframe>(animation, joint, "translate", track->mPositionKeys,
                                                track->mNumPositionKeys, rest.translation, clock,
                                                path);
    addChannel<QuatSphericalLinearChannel, QuatKeyframe>(
        animation, joint, "quaternion", track->mRotationKeys, track->mNumRotationKeys,
        rest.rotation, clock, path);
    addChannel<Vec3LinearChannel, Vec3Keyframe>(animation, joint, "scale", track->mScalingKeys,
                                                track->mNumScalingKeys, rest.scale, clock, path);
    auto* const scales = static_cast<Vec3LinearChannel&>(*animation.getChannels().back())
                             .getSamplerTyped()
                             ->getKeyframeContainerTyped();
    for (Vec3Keyframe& key : *scales) key.setValue(clampedTinyScale(key.getValue()));
}

osg::ref_ptr<osgAnimation::Animation> makeClip(const aiAnimation& source, const std::string& name,
                                               const SceneSkeleton& joints,
                                               const std::vector<bool>& moves,
                                               const std::string& path) {
    const Tracks tracks = tracksOf(source);
    const auto trackOf = [&](std::size_t joint) -> const aiNodeAnim* {
        const auto found = tracks.find(joints.rest.joints[joint].name);
        return found == tracks.end() ? nullptr : found->second;
    };
    Clock clock;
    if (source.mTicksPerSecond > 0.0) clock.ticksPerSecond = source.mTicksPerSecond;
    for (std::size_t j = 0; j < moves.size(); ++j)
        if (const aiNodeAnim* track = trackOf(j)) {
            clock.include(track->mPositionKeys, track->mNumPositionKeys);
            clock.include(track->mRotationKeys, track->mNumRotationKeys);
            clock.include(track->mScalingKeys, track->mNumScalingKeys);
        }
    if (!clock.any) return nullptr;
    if (!std::isfinite(clock.first)) clock.first = 0.0; // a pose
    osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->setName(name);
    clip->setPlayMode(osgAnimation::Animation::LOOP);
    for (std::size_t j = 0; j < moves.size(); ++j)
        if (moves[j])
            addJoint(*clip, joints.rest.joints[j].name, *joints.nodes[j], trackOf(j), clock, path);
    clip->computeDuration();
    return clip;
}

} // namespace

std::vector<bool> movedJoints(const aiScene& scene, const SceneSkeleton& joints) {
    std::vector<bool> moves(joints.nodes.size(), false);
    for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
        const Tracks tracks = tracksOf(*scene.mAnimations[a]);
        for (std::size_t j = 0; j < moves.size(); ++j)
            moves[j] = moves[j] || tracks.count(joints.rest.joints[j].name) != 0;
    }
    return moves;
}

osgAnimation::AnimationList makeClips(const aiScene& scene, const SceneSkeleton& joints,
                                      std::size_t mostSamples, const std::string& path) {
    const std::vector<bool> moves = movedJoints(scene, joints);
    const auto moved = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), true));
    // Every clip has channels for all joints that any clip moves.
    if (moved * scene.mNumAnimations > mostSamples / 8)
        failFile(path, std::to_string(scene.mNumAnimations) + " animations of " +
                           std::to_string(moved) + " joints, expected at most " +
                           std::to_string(mostSamples / 8) + " tracks (option maxSamples)");
    osgAnimation::AnimationList result;
    const std::vector<std::string> names = clipNames(scene);
    for (unsigned a = 0; a < scene.mNumAnimations; ++a)
        if (const auto clip = makeClip(*scene.mAnimations[a], names[a], joints, moves, path))
            result.push_back(clip);
    return result;
}

} // namespace osgSkin
