// SPDX-License-Identifier: MIT
#include <osgSkinRig/MakeAnimation>

#include "clips/ClipChannels.h"
#include "clips/ClipCheck.h"

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

} // namespace osgSkin
