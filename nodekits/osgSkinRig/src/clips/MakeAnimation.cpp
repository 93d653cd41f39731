// SPDX-License-Identifier: MIT
#include <osgSkinRig/MakeAnimation>

#include "bones/BoneChannels.h"
#include "clips/ClipChannels.h"
#include "clips/ClipCheck.h"
#include "clips/ClipOnBones.h"

#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace osgSkin {

osg::ref_ptr<osgAnimation::Animation> makeAnimation(const Clip& clip, const RestSkeleton& rig) {
    requireUsable(clip, rig);
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setName(clip.name);
    animation->setPlayMode(osgAnimation::Animation::LOOP);

    osg::ref_ptr<osgAnimation::Channel> root = rootChannel(clip);
    root->setTargetName(rig.joints[0].name);
    // addChannel() would look at all others again.
    animation->getChannels().push_back(root);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        osg::ref_ptr<osgAnimation::Channel> channel = rotationChannel(clip, j);
        channel->setTargetName(rig.joints[j].name);
        animation->getChannels().push_back(channel);
    }
    animation->computeDuration();
    return animation;
}

osg::ref_ptr<osgAnimation::Animation> makeAnimation(const Clip& clip, const RestSkeleton& rig,
                                                    osgAnimation::Skeleton& skeleton) {
    requireUsable(clip, rig);
    const ClipOnBones bones(clip, rig, skeleton);
    std::vector<std::pair<std::size_t, BoneChannels>> moved;
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (osgAnimation::Bone* bone = bones.bone(j)) moved.emplace_back(j, *bone);
    for (std::size_t f = 0; f <= clip.frames; ++f) { // the last is held
        const auto posed = bones.frame(std::min(f, clip.frames - 1));
        for (auto& [joint, channels] : moved)
            channels.add(static_cast<double>(f) * clip.frameTime, posed[joint].local);
    }
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setName(clip.name);
    animation->setPlayMode(osgAnimation::Animation::LOOP);
    for (const auto& [joint, channels] : moved)
        for (const auto& channel : channels.channels()) animation->getChannels().push_back(channel);
    animation->computeDuration();
    return animation;
}

double keySpeed(const osgAnimation::Animation& animation) {
    constexpr double kSame = 1e-5; // saved texts have six digits
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const auto& channel : animation.getChannels()) {
        first = std::min(first, double(channel->getStartTime()));
        last = std::max(last, double(channel->getEndTime()));
    }
    const double speed = (last - first) / animation.getDuration();
    return std::isfinite(speed) && speed > 0.0 && std::abs(speed - 1.0) > kSame ? speed : 1.0;
}

} // namespace osgSkin
