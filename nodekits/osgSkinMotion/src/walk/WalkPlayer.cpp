// SPDX-License-Identifier: MIT
#include "walk/WalkPlayer.h"

#include "clips/BakedClip.h"
#include "feet/Legs.h"

#include <osgSkin/GlmOsg>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kLevel = 0.003; ///< leg lengths by which a point of the sole is lower

} // namespace

WalkPlayer::WalkPlayer(const Gaits& gaits)
    : GaitState(gaits, 0.0), _toWalker(toGlm(gaits.get().toWalker)),
      _fromRest(rotationOf(_toWalker)) {
    const Gaits::Set& set = gaits.get();
    _unit = glm::length(transformDirection(_toWalker, {0.0, 0.0, 1.0}));
    setLayer(0, {set.standing, 0.0, 0.0, true});
    blendGaits();
    for (std::size_t side = 0; side < set.legs.size(); ++side) {
        _leg += 0.5 * legLength(set.legs[side]);
        _height += 0.5 * jointOf(set.legs[side].hip).z;
        _radius[side] = transformDirection(_toWalker, set.legs[side].ball - set.legs[side].heel).z;
        _floor = std::min(_floor, heightOf(side));
    }
}

glm::dvec3 WalkPlayer::jointOf(std::size_t joint) const {
    const std::vector<SampledClip::Joint>& joints = _gaits->get().standing->joints();
    return transformPoint(_toWalker, apply(_whole[joint], joints[joint].centre));
}

/// Where the clips have a point of a sole.
glm::dvec3 WalkPlayer::soleOf(std::size_t side, SolePoint point) const {
    const Gaits::Leg& leg = _gaits->get().legs[side];
    const glm::dvec3& place = point == Heel ? leg.heel : point == Ball ? leg.ball : leg.tip;
    return transformPoint(_toWalker, apply(_whole[point == Tip ? leg.toe : leg.ankle], place)) -
           glm::dvec3(0.0, 0.0, point == Ball ? _radius[side] : 0.0);
}

double WalkPlayer::heightOf(std::size_t side) const {
    return std::min({soleOf(side, Heel).z, soleOf(side, Ball).z, soleOf(side, Tip).z});
}

/// The point on which a foot rolls: the one that it rolled on before, unless another is lower.
WalkPlayer::SolePoint WalkPlayer::pivotOf(std::size_t side, SolePoint now) const {
    SolePoint pivot = now;
    double height = soleOf(side, now).z - kLevel * _leg;
    for (const SolePoint point : {Heel, Ball, Tip}) {
        const double other = soleOf(side, point).z;
        if (other >= height) continue;
        height = other;
        pivot = point;
    }
    return pivot;
}

double WalkPlayer::legLength(const Gaits::Leg& leg) const {
    const glm::dvec3 knee = jointOf(leg.knee);
    return glm::distance(knee, jointOf(leg.hip)) + glm::distance(jointOf(leg.ankle), knee);
}

void WalkPlayer::blendGaits() {
    const Gaits::Set& set = _gaits->get();
    static thread_local std::vector<JointSample> other;
    const std::size_t count = set.standing->joints().size();
    _joints.resize(count);
    other.resize(count);
    const auto add = [&](const SampledClip& clip, double time, double share) {
        if (share <= 0.0) return;
        clip.evaluate(time, true, share < 1.0 ? other.data() : _joints.data());
        if (share >= 1.0) return;
        const SampleBlend blended(share);
        for (std::size_t j = 0; j < count; ++j) _joints[j] = blended(_joints[j], other[j]);
    };
    const auto addGait = [&](const Gaits::Gait& gait, double share) {
        if (gait.clip) add(*gait.clip, _phase * gait.clip->duration(), share);
    };
    if (_walking > 0.0) {
        addGait(set.walking, 1.0);
        addGait(set.running, _running);
    }
    add(*set.standing, _standingTime, 1.0 - _walking);
    localToModel(set.standing->joints(), _joints.data(), _whole);
}

void WalkPlayer::follow(const GaitState& gait, double dt, const Feet* feet) {
    static_cast<GaitState&>(*this) = gait;
    if (feet) _feet = *feet;
    blendGaits();
    for (std::size_t side = 0; side < _feet.size(); ++side) {
        Foot& foot = _feet[side];
        if (_hasJumped) foot.isPlaced = false;
        if (feet) stayAt(foot, soleOf(side, foot.pivot));
    }
    moveFeet(dt, _phaseStep);
    bendLegs();
    advance(dt);
}

void WalkPlayer::show(const std::vector<JointSample>& joints) {
    _joints = joints;
    localToModel(_gaits->get().standing->joints(), _joints.data(), _whole);
}

osg::Matrixd WalkPlayer::matrixOf(std::size_t joint) const {
    return toMatrix(_whole[joint]) * _gaits->get().toWalker;
}

bool WalkPlayer::playClip(const SampledClip& clip, double fade) {
    const Gaits::Set& set = _gaits->get();
    Layer layer{&clip, 0.0, 1.0, false};
    layer.fadeOut = fade;
    return playOn(set.standing->joints()[set.upperBody].name, layer, fade);
}

} // namespace osgSkin
