// SPDX-License-Identifier: MIT
#include "load/LoadSteps.h"

#include <osg/Quat>
#include <osg/Vec3>
#include <osgAnimation/Channel>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kFar = 0.1;          ///< of the skeleton's size: farther than lips and cheeks move
const double kTurned = std::cos(0.2); ///< of half an angle
constexpr float kLeast = 0.25f;       ///< ratio of skin that is between two joints
constexpr double kMany = 0.01;        ///< share of the vertices

template <typename Channel, typename Differs>
bool anyKey(const osgAnimation::Channel& channel, const Differs& differs) {
    const auto* typed = dynamic_cast<const Channel*>(&channel);
    if (typed == nullptr || typed->getSamplerTyped() == nullptr) return false;
    const auto* keys = typed->getSamplerTyped()->getKeyframeContainerTyped();
    if (keys == nullptr || keys->empty()) return false;
    const auto first = keys->front().getValue();
    return std::any_of(keys->begin(), keys->end(),
                       [&](const auto& key) { return differs(key.getValue(), first); });
}

/// The joints that an animation moves far against those above and rotates as well.
std::vector<bool> carriedJoints(const CharacterSource& source) {
    const std::map<std::string, int> jointOf = source.rest.byName();
    glm::dvec3 low = source.rest.joints.front().centre, high = low;
    for (const RestJoint& joint : source.rest.joints) {
        low = glm::min(low, joint.centre);
        high = glm::max(high, joint.centre);
    }
    const double far = kFar * glm::distance(low, high);
    std::vector<bool> moves(source.rest.joints.size(), false), turns = moves;
    for (const auto& animation : source.animations)
        for (const auto& channel : animation->getChannels()) {
            const auto joint = jointOf.find(channel->getTargetName());
            if (joint == jointOf.end()) continue;
            const auto j = static_cast<std::size_t>(joint->second);
            if (channel->getName() != "scale" &&
                anyKey<osgAnimation::Vec3LinearChannel>(
                    *channel,
                    [&](const osg::Vec3& a, const osg::Vec3& b) { return (a - b).length() > far; }))
                moves[j] = true;
            if (anyKey<osgAnimation::QuatSphericalLinearChannel>(
                    *channel, [](const osg::Quat& a, const osg::Quat& b) {
                        return std::abs(a.asVec4() * b.asVec4()) < kTurned;
                    }))
                turns[j] = true;
        }
    for (std::size_t j = 0; j < moves.size(); ++j) moves[j] = moves[j] && turns[j];
    return moves;
}

} // namespace

void warnFlatSkeleton(CharacterSource& source, const Binding& binding) {
    const std::vector<bool> carried = carriedJoints(source);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> between;
    for (std::size_t v = 0; v + 1 < binding.firstInfluence.size(); ++v) {
        const auto begin = binding.influences.begin() + binding.firstInfluence[v];
        const auto end = binding.influences.begin() + binding.firstInfluence[v + 1];
        const auto isPart = [](const Influence& i) {
            return i.bend >= kLeast && i.bend <= 1.0f - kLeast;
        };
        for (auto a = begin; a != end; ++a)
            for (auto b = a + 1; b != end; ++b)
                if ((carried[a->joint] || carried[b->joint]) && isPart(*a) && isPart(*b) &&
                    binding.joints[a->joint].parent == binding.joints[b->joint].parent)
                    ++between[std::minmax(a->joint, b->joint)];
    }
    for (const auto& [joints, count] : between) {
        if (double(count) < kMany * double(binding.firstInfluence.size())) continue;
        warn(source.notes, source.meshFile + ": skin between the joints \"" +
                               binding.joints[joints.first].name + "\" and \"" +
                               binding.joints[joints.second].name +
                               "\" may tear: they hang side by side on one joint, but a clip moves "
                               "one as if it hung on the other; export the bones' hierarchy");
        return;
    }
}

} // namespace osgSkin
