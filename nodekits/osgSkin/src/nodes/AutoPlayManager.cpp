// SPDX-License-Identifier: MIT
#include <osgSkin/AutoPlayManager>

#include "nodes/NameLinker.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {

AutoPlayManager::AutoPlayManager(const AutoPlayManager& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osgAnimation::BasicAnimationManager(
                                                                    other, copyop) {
    // A copy plays nothing yet, so it starts by itself too.
}

void AutoPlayManager::registerAnimations(const osgAnimation::AnimationList& animations) {
    if (animations.empty()) return;
    _animations.insert(_animations.end(), animations.begin(), animations.end() - 1);
    registerAnimation(animations.back());
}

void AutoPlayManager::link(osg::Node* subgraph) {
    if (_linker.valid()) { // an application's own
        osgAnimation::BasicAnimationManager::link(subgraph);
        return;
    }
    const osg::ref_ptr<NameLinker> linker = new NameLinker(_animations);
    subgraph->accept(*linker);
    _needToLink = false;
    buildTargetReference();
}

void AutoPlayManager::update(double time) {
    if (!std::isfinite(time)) return; // OSG would add to it from then on
    if (!_started) {
        _started = true;
        const bool playing = std::any_of(_animationsPlaying.begin(), _animationsPlaying.end(),
                                         [](const auto& layer) { return !layer.second.empty(); });
        _lastUpdate = time; // when what is played begins
        if (!playing && !_animations.empty()) playAnimation(_animations.front());
    }
    // OSG divides by a pose's length, unless it is repeated, and looks behind its only key then.
    for (const auto& layer : _animationsPlaying)
        for (const osg::ref_ptr<osgAnimation::Animation>& clip : layer.second)
            if (clip->getPlayMode() != osgAnimation::Animation::LOOP &&
                clip->getDuration() == 0.0 && clip->computeDurationFromChannels() == 0.0)
                clip->setPlayMode(osgAnimation::Animation::LOOP);
    osgAnimation::BasicAnimationManager::update(time);
}

} // namespace osgSkin
