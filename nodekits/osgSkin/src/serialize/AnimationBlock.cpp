// SPDX-License-Identifier: MIT
#include "serialize/AnimationBlock.h"

#include "core/ContentHash.h"
#include "serialize/BlockWords.h"
#include "serialize/SharedObjects.h"

#include <osgSkin/Error>
#include <osgSkin/ShareEqualData>

#include <osg/Quat>
#include <osg/Vec3>
#include <osgAnimation/Animation>
#include <osgAnimation/Channel>
#include <osgAnimation/Keyframe>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <type_traits>
#include <typeinfo>

namespace osgSkin {
namespace {

using Words = std::vector<std::uint32_t>;

void putValue(const osg::Quat& value, BlockWriter& out) {
    for (int i = 0; i < 4; ++i) out.put(value[i]);
}
void putValue(const osg::Vec3& value, BlockWriter& out) {
    for (int i = 0; i < 3; ++i) out.put(value[i]);
}
template <typename Number>
void putValue(Number value, BlockWriter& out) {
    out.put(value);
}

void takeValue(BlockReader& in, osg::Quat& value) {
    for (int i = 0; i < 4; ++i) value[i] = in.longReal();
}
void takeValue(BlockReader& in, osg::Vec3& value) {
    for (int i = 0; i < 3; ++i) value[i] = in.real();
}
void takeValue(BlockReader& in, float& value) {
    value = in.real();
}
void takeValue(BlockReader& in, double& value) {
    value = in.longReal();
}

/// Whether bones can be where a value puts them.
bool isInRange(double number) {
    return std::abs(number) <= 1e18; // not NaN
}
template <typename Vector>
auto isInRange(const Vector& value) -> decltype(value._v, bool()) {
    return std::all_of(std::begin(value._v), std::end(value._v),
                       [](double x) { return isInRange(x); });
}

constexpr std::size_t kTimeWords = 2;

/// Words of a value.
template <typename Value>
constexpr std::size_t kValueWords = 0;
template <>
constexpr std::size_t kValueWords<osg::Quat> = 8;
template <>
constexpr std::size_t kValueWords<osg::Vec3> = 3;
template <>
constexpr std::size_t kValueWords<float> = 1;
template <>
constexpr std::size_t kValueWords<double> = 2;

template <typename Value>
void putKeys(const osgAnimation::TemplateKeyframeContainer<Value>& keys, BlockWriter& out) {
    out.words.reserve(out.words.size() + keys.size() * (kTimeWords + kValueWords<Value>));
    for (const auto& key : keys) {
        out.put(key.getTime());
        putValue(key.getValue(), out);
    }
}

/// The living container with these keys; else `make()`, which it then is.
template <typename Value, typename Make>
osg::ref_ptr<osgAnimation::TemplateKeyframeContainer<Value>>
sharedKeys(const std::uint32_t* words, std::size_t count, const Make& make) {
    using Keys = osgAnimation::TemplateKeyframeContainer<Value>;
    auto& shared = SharedObjects<Keys>::instance();
    ContentHash content;
    content.add(words, count * sizeof *words);
    // Keys can be edited, so that a container's present ones decide.
    const auto isEqual = [&](const Keys& keys) {
        constexpr std::size_t kKeyWords = kTimeWords + kValueWords<Value>;
        if (keys.size() * kKeyWords != count) return false;
        BlockWriter own;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            own.words.clear();
            own.put(keys[i].getTime());
            putValue(keys[i].getValue(), own);
            if (!std::equal(own.words.begin(), own.words.end(), words + i * kKeyWords))
                return false;
        }
        return true;
    };
    osg::ref_ptr<Keys> known = shared.find(content);
    if (known && isEqual(*known)) return known;
    return shared.add(content, osg::ref_ptr<Keys>(make()), isEqual);
}

/// Calls `visit` with a channel of one of the classes that blocks have, and its kind.
/// \return false for channels of other classes, and those without keys
template <typename Visit>
bool visitChannel(osgAnimation::Channel& channel, const Visit& visit) {
    const std::type_info& type = typeid(channel);
    const auto visited = [&](std::uint32_t kind, auto& of) {
        if (!of.getSamplerTyped() || !of.getSamplerTyped()->getKeyframeContainerTyped())
            return false;
        visit(kind, of);
        return true;
    };
    if (type == typeid(osgAnimation::QuatSphericalLinearChannel))
        return visited(1, static_cast<osgAnimation::QuatSphericalLinearChannel&>(channel));
    if (type == typeid(osgAnimation::Vec3LinearChannel))
        return visited(2, static_cast<osgAnimation::Vec3LinearChannel&>(channel));
    if (type == typeid(osgAnimation::FloatLinearChannel))
        return visited(3, static_cast<osgAnimation::FloatLinearChannel&>(channel));
    if (type == typeid(osgAnimation::DoubleLinearChannel))
        return visited(4, static_cast<osgAnimation::DoubleLinearChannel&>(channel));
    return false;
}

bool hasPlace(const osgAnimation::Animation& animation) {
    if (typeid(animation) != typeid(osgAnimation::Animation) || animation.getUserDataContainer())
        return false;
    for (const auto& channel : animation.getChannels())
        if (!channel || !visitChannel(*channel, [](std::uint32_t, auto&) {})) return false;
    return true;
}

template <typename Channel>
osg::ref_ptr<osgAnimation::Channel> takeChannel(BlockReader& in) {
    using Keys = typename Channel::KeyframeContainerType;
    using Value = typename Keys::KeyType::value_type;
    const osg::ref_ptr<Channel> channel = new Channel;
    channel->setName(in.text());
    channel->setTargetName(in.text());
    constexpr std::size_t kKeyWords = kTimeWords + kValueWords<Value>;
    const std::uint32_t count = in.count("keys", kKeyWords);
    BlockReader keys = in;
    const std::uint32_t* const words = in.skip(count * kKeyWords);
    channel->getOrCreateSampler()->setKeyframeContainer(
        sharedKeys<Value>(words, count * kKeyWords, [&] {
            const osg::ref_ptr<Keys> made = new Keys;
            made->reserve(count);
            for (std::uint32_t i = 0; i < count; ++i) {
                const double time = keys.longReal();
                Value value;
                takeValue(keys, value);
                if (!std::isfinite(time)) in.fail("a key's time is not finite");
                if (!isInRange(value))
                    in.fail("a key's value is not finite, or beyond -1e18 to 1e18");
                made->push_back({time, value});
            }
            return made;
        }));
    return channel;
}

osg::ref_ptr<osgAnimation::Channel> takeChannel(BlockReader& in) {
    const std::uint32_t kind = in.word();
    switch (kind) {
    case 1:
        return takeChannel<osgAnimation::QuatSphericalLinearChannel>(in);
    case 2:
        return takeChannel<osgAnimation::Vec3LinearChannel>(in);
    case 3:
        return takeChannel<osgAnimation::FloatLinearChannel>(in);
    case 4:
        return takeChannel<osgAnimation::DoubleLinearChannel>(in);
    default:
        in.fail("a channel of kind " + std::to_string(kind) + ", expected 1 to 4");
    }
}

} // namespace

std::vector<std::uint32_t> packAnimations(const osgAnimation::AnimationList& animations) {
    BlockWriter out;
    out.put(animations.size());
    for (const auto& animation : animations) {
        const bool isIn = hasPlace(*animation);
        out.put(std::uint32_t{isIn ? 1u : 0u});
        if (!isIn) continue;
        out.put(animation->getName());
        out.put(animation->getDuration());
        out.put(animation->getStartTime());
        out.put(animation->getWeight());
        out.put(static_cast<std::uint32_t>(animation->getPlayMode()));
        out.put(animation->getChannels().size());
        for (const auto& channel : animation->getChannels())
            visitChannel(*channel, [&](std::uint32_t kind, auto& of) {
                out.put(kind);
                out.put(of.getName());
                out.put(of.getTargetName());
                const auto& keys = *of.getSamplerTyped()->getKeyframeContainerTyped();
                out.put(std::size_t{keys.size()});
                putKeys(keys, out);
            });
    }
    return out.words;
}

osgAnimation::AnimationList unpackAnimations(const std::vector<std::uint32_t>& words) {
    BlockReader in(words, "animations' block");
    osgAnimation::AnimationList animations(in.count("animations", 1));
    for (auto& animation : animations) {
        if (in.word() == 0) continue;
        animation = new osgAnimation::Animation;
        animation->setName(in.text());
        const double duration = in.longReal();
        animation->setStartTime(in.longReal());
        animation->setWeight(in.real());
        const std::uint32_t mode = in.word();
        if (mode > osgAnimation::Animation::PPONG) in.fail("unknown play mode");
        animation->setPlayMode(static_cast<osgAnimation::Animation::PlayMode>(mode));
        const std::uint32_t channels = in.count("channels", 4);
        for (std::uint32_t c = 0; c < channels; ++c)
            animation->getChannels().push_back(takeChannel(in));
        animation->setDuration(duration);
    }
    if (!in.atEnd()) in.fail("there is more in it than animations");
    return animations;
}

void shareEqualKeys(const osgAnimation::AnimationList& animations) {
    for (const auto& animation : animations) {
        if (!animation) continue;
        for (const auto& channel : animation->getChannels()) {
            if (!channel) continue;
            visitChannel(*channel, [](std::uint32_t, auto& of) {
                auto* const sampler = of.getSamplerTyped();
                using Keys = typename std::decay_t<decltype(of)>::KeyframeContainerType;
                const osg::ref_ptr<Keys> own = sampler->getKeyframeContainerTyped();
                BlockWriter words;
                putKeys(*own, words);
                sampler->setKeyframeContainer(
                    sharedKeys<typename Keys::KeyType::value_type>(
                        words.words.data(), words.words.size(), [&] { return own; })
                        .get());
            });
        }
    }
}

} // namespace osgSkin
