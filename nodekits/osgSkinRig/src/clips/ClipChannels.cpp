// SPDX-License-Identifier: MIT
#include "clips/ClipChannels.h"

#include <osgSkin/GlmOsg>

#include <osgAnimation/Channel>
#include <osgAnimation/Sampler>

#include <algorithm>

namespace osgSkin {
namespace {

/// Calls `add(sample, time)` for each key. The last sample is held for its frame's time: every
/// sample then has its part of the loop, none lies on the loop's end (where osgAnimation, with the
/// duration as a float, shows the first), and a single sample has a duration too.
template <typename Add>
void forEachKey(const Clip& clip, const Add& add) {
    for (std::size_t f = 0; f <= clip.frames; ++f)
        add(std::min(f, clip.frames - 1), static_cast<double>(f) * clip.frameTime);
}

} // namespace

osg::ref_ptr<osgAnimation::Channel> rotationChannel(const Clip& clip, std::size_t joint) {
    osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    channel->setName("quaternion");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    glm::dquat previous(1.0, 0.0, 0.0, 0.0);
    forEachKey(clip, [&](std::size_t sample, double time) {
        // q and -q are the same rotation; the nearer one makes the interpolation take the short
        // arc.
        glm::dquat q = clip.rotations[sample * clip.joints + joint];
        if (glm::dot(previous, q) < 0.0) q = -q;
        keys->push_back(osgAnimation::QuatKeyframe(time, toOsg(q)));
        previous = q;
    });
    return channel;
}

osg::ref_ptr<osgAnimation::Channel> rootChannel(const Clip& clip) {
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel = new osgAnimation::Vec3LinearChannel;
    channel->setName("translate");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    forEachKey(clip, [&](std::size_t sample, double time) {
        keys->push_back(
            osgAnimation::Vec3Keyframe(time, osg::Vec3(toOsg(clip.rootPositions[sample]))));
    });
    return channel;
}

} // namespace osgSkin
