// SPDX-License-Identifier: MIT
#include "saved/checks/CheckAnimation.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <osgAnimation/CubicBezier>
#include <osgAnimation/Keyframe>
#include <osgAnimation/Sampler>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

enum class Keys { NotOfThisKind, Fine, WrongTimes, WrongValues };

bool isFine(double value) {
    return std::abs(value) <= kLargestCoordinate; // false for NaN too
}

/// OSG blends rotations as they are: one of another length would scale what it turns.
bool isFine(const osg::Quat& rotation) {
    return std::abs(rotation.length() - 1.0) < 0.1; // false for NaN too
}

template <typename Value>
auto isFine(const Value& vector) -> decltype(bool(Value::num_components)) {
    for (int i = 0; i < int(Value::num_components); ++i)
        if (!isFine(double(vector.ptr()[i]))) return false;
    return true;
}

bool isFine(const osg::Matrixf& matrix) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](double x) { return isFine(x); });
}

template <typename Value>
bool isFine(const osgAnimation::TemplateCubicBezier<Value>& bezier) {
    return isFine(bezier.getPosition()) && isFine(bezier.getControlPointIn()) &&
           isFine(bezier.getControlPointOut());
}

template <typename Value>
Keys keysOf(const osgAnimation::KeyframeContainer& container) {
    const auto* keys =
        dynamic_cast<const osgAnimation::TemplateKeyframeContainer<Value>*>(&container);
    if (keys == nullptr) return Keys::NotOfThisKind;
    double before = -HUGE_VAL;
    for (const auto& key : *keys) {
        if (!std::isfinite(key.getTime()) || key.getTime() < before) return Keys::WrongTimes;
        if (!isFine(key.getValue())) return Keys::WrongValues;
        before = key.getTime();
    }
    return Keys::Fine;
}

template <typename... Values>
Keys lookAt(const osgAnimation::KeyframeContainer& container) {
    Keys found = Keys::NotOfThisKind;
    ((found = found == Keys::NotOfThisKind ? keysOf<Values>(container) : found), ...);
    return found;
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
        const Keys found = lookAt<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat,
                                  osg::Matrixf, FloatCubicBezier, DoubleCubicBezier,
                                  Vec2CubicBezier, Vec3CubicBezier, Vec4CubicBezier>(*keys);
        if (found == Keys::WrongValues)
            return which + " with values of keys that are not finite, or beyond -1e18 to 1e18, or "
                           "rotations that are not of length 1";
        if (found != Keys::Fine)
            return which + " with times of keys that are not finite or not in order";
    }
    if (!std::isfinite(animation.getDuration()) || !std::isfinite(animation.getStartTime()))
        return "a duration or a start that is not finite";
    return {};
}

} // namespace osgSkin
