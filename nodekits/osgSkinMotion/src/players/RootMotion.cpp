// SPDX-License-Identifier: MIT
// How layers move the root along the ground.
#include "players/ClipLayers.h"

#include <osgSkin/GlmOsg>

#include <osg/Quat>

#include <cmath>

namespace osgSkin {
namespace {

constexpr double kAlike = 1.0 - 1e-8; ///< cosine of half the angle between rotations, 3e-4 radians

/// The same angle from -pi to pi.
double wrapped(double angle) {
    return std::remainder(angle, 2.0 * osg::PI);
}

} // namespace

void ClipLayers::setRoot(Root root, const osg::Vec3d& up) {
    _root = root;
    osg::Vec3d unit = up;
    if (std::isfinite(unit.normalize()) && unit.valid()) _up = unit;
    _motion = {};
}

ClipLayers::GroundMove ClipLayers::takeMotion() {
    const GroundMove result = _motion;
    _motion = {};
    return result;
}

ClipLayers::GroundMove ClipLayers::then(const GroundMove& first, const GroundMove& next) const {
    return {first.angle + next.angle, first.shift + osg::Quat(first.angle, _up) * next.shift};
}

ClipLayers::GroundMove ClipLayers::reversed(const GroundMove& move) const {
    return {-move.angle, osg::Quat(-move.angle, _up) * -move.shift};
}

ClipLayers::GroundMove ClipLayers::power(GroundMove move, double times) const {
    if (times < 0.0) return power(reversed(move), -times);
    GroundMove result;
    for (; times >= 1.0; times = std::floor(0.5 * times)) {
        if (std::fmod(times, 2.0) == 1.0) result = then(result, move);
        move = then(move, move);
    }
    return result;
}

double ClipLayers::headingOf(const JointSample& root) const {
    if (_root != Root::ExtractedWithTurn) return 0.0;
    const glm::dquat& q = root.rotation; // its part about `up`, before which the rest bends
    return 2.0 * std::atan2(q.x * _up.x() + q.y * _up.y() + q.z * _up.z(), q.w);
}

/// From the first sample to another, about the root's position in the first sample.
ClipLayers::GroundMove ClipLayers::rootMove(const SampledClip& clip,
                                            const JointSample& root) const {
    const JointSample& first = clip.sample(0)[clip.rootJoint()];
    return {headingOf(root) - headingOf(first),
            alongGround(toOsg(root.translation - first.translation))};
}

/// The move from the first sample to a time within its loop.
///
/// \param loops set to the number of loops before
ClipLayers::GroundMove ClipLayers::rootAt(const Layer& layer, double time, double& loops) const {
    const SampledClip& clip = *layer.clip;
    const SampledClip::Interval at = clip.intervalAt(time, layer.loop);
    const auto rootOf = [&](std::size_t sample) { return clip.sample(sample)[clip.rootJoint()]; };
    loops = 0.0;
    if (layer.loop)
        loops = std::round((time / clip.step() - static_cast<double>(at.from) - at.share) /
                           static_cast<double>(clip.sampleCount()));
    if (at.from <= at.to)
        return rootMove(clip, osgSkin::blend(rootOf(at.from), rootOf(at.to), at.share));
    GroundMove step = seamStep(clip);
    step.angle *= at.share;
    step.shift *= at.share;
    return then(rootMove(clip, rootOf(at.from)), step);
}

/// Whether two samples have the same pose, wherever the root is on the ground.
bool ClipLayers::areAlike(const SampledClip& clip, std::size_t a, std::size_t b) const {
    for (std::size_t j = 0; j < clip.joints().size(); ++j) {
        JointSample one = clip.sample(a)[j], other = clip.sample(b)[j];
        if (j == clip.rootJoint()) {
            keepInPlace(clip, one);
            keepInPlace(clip, other);
        }
        if (std::abs(glm::dot(one.rotation, other.rotation)) < kAlike) return false;
    }
    return true;
}

/// The step from the last sample back to the first: the mean of its neighbours, or none where the
/// last repeats the first, as many files of cycles have it: feet then stand for that step.
ClipLayers::GroundMove ClipLayers::seamStep(const SampledClip& clip) const {
    const std::size_t last = clip.sampleCount() - 1;
    if (last == 0 || (areAlike(clip, last, 0) && !areAlike(clip, 1, 0))) return {};
    const auto moveAt = [&](std::size_t i) {
        return rootMove(clip, clip.sample(i)[clip.rootJoint()]);
    };
    const GroundMove before = then(reversed(moveAt(last - 1)), moveAt(last)), after = moveAt(1);
    return {0.5 * (wrapped(before.angle) + wrapped(after.angle)),
            (before.shift + after.shift) * 0.5};
}

/// The move of a layer's root in the step of advance().
ClipLayers::GroundMove ClipLayers::rootStep(const Slot& slot) const {
    if (_root == Root::FromFeet && slot.layer.loop) {
        const glm::dvec3& velocity = slot.layer.clip->footContacts().velocity;
        if (velocity != glm::dvec3(0.0))
            return {0.0, alongGround(toOsg(velocity)) * (slot.layer.time - slot.before)};
    }
    double before = 0.0, after = 0.0;
    const GroundMove from = rootAt(slot.layer, slot.before, before);
    GroundMove to = rootAt(slot.layer, slot.layer.time, after);
    if (before != after) {
        const SampledClip& clip = *slot.layer.clip;
        const JointSample& last = clip.sample(clip.sampleCount() - 1)[clip.rootJoint()];
        to = then(power(then(rootMove(clip, last), seamStep(clip)), after - before), to);
    }
    return then(reversed(from), to);
}

/// Blends the layers' moves as their poses are blended.
void ClipLayers::advanceRoot() {
    GroundMove move;
    osg::Vec3d pivot, rest;
    double uncovered = 1.0; // by the layers above
    for (std::size_t i = _slots.size(); i-- > 0;) {
        const Slot& slot = _slots[i];
        const double share = uncovered * slot.layer.weight;
        if (!slot.isActive() || !slot.movesRoot || share == 0.0) continue;
        const GroundMove own = rootStep(slot);
        move.angle += share * wrapped(own.angle);
        move.shift += own.shift * share;
        if (slot.layer.additive) continue;
        const SampledClip& clip = *slot.layer.clip;
        rest = toOsg(clip.joints()[clip.rootJoint()].centre);
        pivot += alongGround(rest + toOsg(clip.sample(0)[clip.rootJoint()].translation)) * share;
        uncovered -= share;
    }
    pivot += alongGround(rest) * uncovered;
    move.shift += pivot - osg::Quat(move.angle, _up) * pivot;
    _motion = then(_motion, move);
}

/// Removes what Root says from a root's transform in a clip.
void ClipLayers::keepInPlace(const SampledClip& clip, JointSample& root) const {
    const GroundMove gone = rootMove(clip, root);
    root.translation -= toGlm(gone.shift);
    if (gone.angle != 0.0) root.rotation = glm::angleAxis(-gone.angle, toGlm(_up)) * root.rotation;
}

} // namespace osgSkin
