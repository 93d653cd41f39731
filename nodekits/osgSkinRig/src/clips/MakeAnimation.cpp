// SPDX-License-Identifier: MIT
#include <osgSkinRig/MakeAnimation>

#include "clips/ClipChannels.h"
#include "clips/ClipCheck.h"

#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>
#include <limits>

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
