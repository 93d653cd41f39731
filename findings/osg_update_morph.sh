#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, osgAnimation::UpdateMorph: the name that its constructor takes links no
# channel, unlike that of UpdateBone and UpdateMatrixTransform; only names of addTarget() do. One
# expects that a channel whose target is the name sets the weight.
# Needs g++ and OpenSceneGraph's headers.
. "$(dirname "$0")/common.sh"
debian_package libopenscenegraph-dev 3.6.5+dfsg1-8+b2
cat >morph.cpp <<'END'
#include <osg/FrameStamp>
#include <osg/Geode>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/MorphGeometry>
#include <osgUtil/UpdateVisitor>
#include <iostream>

/// The weight of a target after 0.75 seconds of a clip that raises it from 0 to 1.
float weightAfter(bool withTarget) {
    osg::Geometry* quad = osg::createTexturedQuadGeometry({}, osg::X_AXIS, osg::Z_AXIS);
    osgAnimation::MorphGeometry* morph = new osgAnimation::MorphGeometry(*quad);
    morph->addMorphTarget(quad, 0.0f);
    osgAnimation::UpdateMorph* update = new osgAnimation::UpdateMorph("face");
    if (withTarget) update->addTarget("face");
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(morph);
    geode->setUpdateCallback(update);

    osgAnimation::FloatLinearChannel* channel = new osgAnimation::FloatLinearChannel;
    channel->setTargetName("face");
    channel->setName("0");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::FloatKeyframe(0.0, 0.0f));
    keys->push_back(osgAnimation::FloatKeyframe(1.0, 1.0f));
    osgAnimation::Animation* animation = new osgAnimation::Animation;
    animation->addChannel(channel);
    animation->setPlayMode(osgAnimation::Animation::ONCE);
    osgAnimation::BasicAnimationManager* manager = new osgAnimation::BasicAnimationManager;
    manager->registerAnimation(animation);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->setUpdateCallback(manager);
    scene->addChild(geode);

    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    for (unsigned int i = 0; i <= 3; ++i) {
        stamp->setFrameNumber(i);
        stamp->setSimulationTime(0.25 * i);
        if (i == 1) manager->playAnimation(animation);
        scene->accept(visitor);
    }
    return morph->getMorphTarget(0).getWeight();
}

int main() {
    osg::setNotifyLevel(osg::FATAL);
    std::cout << "a name alone: " << weightAfter(false) << "\n"
              << "and addTarget(): " << weightAfter(true) << std::endl;
}
END
g++ -w morph.cpp -o morph -losgAnimation -losgUtil -losg -lOpenThreads
./morph >seen
expect <<'END'
a name alone: 0
and addTarget(): 0.75
END
