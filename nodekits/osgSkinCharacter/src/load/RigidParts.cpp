// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/RigidParts.h"

#include <osgSkinBind/RigidJoints>

#include <osg/Quat>
#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace osgSkin {
namespace {

/// A joint moves that turns by more than this from its rest pose: cosine of half of one degree.
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
