// SPDX-License-Identifier: MIT
#include "saved/checks/CheckAnimation.h"

#include "text/FileText.h"

#include <osgAnimation/CubicBezier>
#include <osgAnimation/Keyframe>
#include <osgAnimation/Sampler>

#include <cmath>

namespace osgSkin {
namespace {

enum class Times { NotOfThisKind, Fine, Wrong };

template <typename Value>
Times timesOf(const osgAnimation::KeyframeContainer& container) {
    const auto* keys =
        dynamic_cast<const osgAnimation::TemplateKeyframeContainer<Value>*>(&container);
    if (keys == nullptr) return Times::NotOfThisKind;
    double before = -HUGE_VAL;
    for (const auto& key : *keys) {
        if (!std::isfinite(key.getTime()) || key.getTime() < before) return Times::Wrong;
        before = key.getTime();
    }
    return Times::Fine;
}

template <typename... Values>
bool areInOrder(const osgAnimation::KeyframeContainer& container) {
    Times found = Times::NotOfThisKind;
    ((found = found == Times::NotOfThisKind ? timesOf<Values>(container) : found), ...);
    return found == Times::Fine;
}

} // namespace

std::string whyNotPlayed(const osgAnimation::Animation& animation) {
    using namespace osgAnimation;
    for (const osg::ref_ptr<Channel>& channel : animation.getChannels()) {
        if (!channel) return "a channel that is none";
        const std::string which = "channel " + inQuotes(channel->getName()) + " of joint " +
                                  inQuotes(channel->getTargetName());
        const Sampler* sampler = channel->getSampler();
        const KeyframeContainer* keys =
            sampler != nullptr ? sampler->getKeyframeContainer() : nullptr;
        if (keys == nullptr || keys->size() == 0) return which + " without keys";
        if (!areInOrder<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat, osg::Matrixf,
                        FloatCubicBezier, DoubleCubicBezier, Vec2CubicBezier, Vec3CubicBezier,
                        Vec4CubicBezier>(*keys))
            return which + " with times of keys that are not finite or not in order";
    }
    return {};
}

} // namespace osgSkin
