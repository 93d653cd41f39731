// SPDX-License-Identifier: MIT
#include <osgSkinMotion/LivePlayer>

#include "bones/Figure.h"

#include <osgSkinRig/Clip>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kRestart = 1.0; ///< seconds back in time
constexpr double kPause = 0.1;   ///< seconds without a pose; more than a lost one or two
constexpr double kFade = 0.2;    ///< seconds

/// A clip that stays at rest.
osg::ref_ptr<const SampledClip> restClip(const RestSkeleton& rig) {
    Clip clip;
    clip.name = "live";
    clip.frameTime = 1.0;
    clip.frames = 1;
    clip.joints = rig.joints.size();
    clip.rotations.resize(clip.joints, {1.0, 0.0, 0.0, 0.0});
    clip.rootPositions.push_back(rig.joints.front().centre);
    return SampledClip::create(clip, rig);
}

} // namespace

LivePlayer::LivePlayer(const LivePlayer& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), ClipPlayer(other, copyop),
      _target(other._shown), _shown(other._shown) {}

osg::ref_ptr<LivePlayer> LivePlayer::create(osg::Node& root, LiveRetarget retarget) {
    const osg::ref_ptr<LivePlayer> player = new LivePlayer;
    player->setFigure(root, findFigure(root, "live player"));
    player->setLayer(0, {restClip(retarget.rig()), 0.0, 0.0});
    player->_next.resize(retarget.rig().joints.size());
    player->_shown = player->_target = player->_received = player->_next; // at rest
    player->_retarget.emplace(std::move(retarget));
    return player;
}

bool LivePlayer::receive(double time, const std::vector<glm::dquat>& rotations,
                         const glm::dvec3& root) {
    if (!_retarget || rotations.size() != _retarget->source().joints.size() || !std::isfinite(time))
        return false;
    const bool isFirst = !_hasTime || time <= _time - kRestart;
    if (!isFirst && time <= _time) return false;
    if (isFirst) _retarget->restart();
    if (!_retarget->apply(rotations.data(), root, _next.data())) return false;
    _time = time;
    _hasTime = true;
    const std::lock_guard<std::mutex> lock(_mutex);
    std::swap(_received, _next);
    _isNew = true;
    _isFirst = _isFirst || isFirst;
    return true;
}

const JointSample* LivePlayer::posedJoints() const {
    return _shown.empty() ? nullptr : _shown.data();
}

/// Moves what is shown towards the newest pose.
void LivePlayer::show(double dt) {
    _silence += dt;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_isNew) {
            if (_isFirst || _silence > kPause) _fade = kFade;
            std::swap(_target, _received);
            _silence = 0.0;
            _isNew = _isFirst = false;
        }
    }
    const double share = dt < _fade ? dt / _fade : 1.0;
    _fade = std::max(0.0, _fade - dt);
    for (std::size_t j = 0; j < _shown.size(); ++j) _shown[j] = blend(_shown[j], _target[j], share);
}

void LivePlayer::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    if (nv && nv->getFrameStamp()) {
        const double now = nv->getFrameStamp()->getSimulationTime();
        show(_updated && now > _last ? now - _last : 0.0);
        _last = now;
        _updated = true;
    }
    ClipPlayer::operator()(node, nv);
}

} // namespace osgSkin
