// SPDX-License-Identifier: MIT
#include <osgSkinRig/SampledClip>

#include "clips/BoneSampler.h"
#include "clips/ClipCheck.h"
#include "clips/SampleBlend.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Of all joints together, 640 MB: a figure of 100 joints for half an hour.
constexpr double kMostJointSamples = 1e7;

} // namespace

JointSample blend(const JointSample& a, const JointSample& b, double share) noexcept {
    return SampleBlend(share)(a, b);
}

osg::ref_ptr<const SampledClip> SampledClip::create(const Clip& clip, const RestSkeleton& rig) {
    requireUsable(clip, rig);
    const osg::ref_ptr<SampledClip> result = new SampledClip;
    result->_name = clip.name;
    result->_step = clip.frameTime;
    for (const RestJoint& joint : rig.joints)
        result->_joints.push_back({joint.name, joint.parent, joint.centre});
    result->_samples.resize(clip.frames * clip.joints);
    for (std::size_t i = 0; i < result->_samples.size(); ++i)
        result->_samples[i].rotation = glm::normalize(clip.rotations[i]);
    for (std::size_t f = 0; f < clip.frames; ++f)
        result->_samples[f * clip.joints].translation =
            clip.rootPositions[f] - rig.joints.front().centre;
    result->findRoot();
    return result;
}

osg::ref_ptr<const SampledClip> SampledClip::create(const osgAnimation::Animation& animation,
                                                    osgAnimation::Skeleton& skeleton,
                                                    double samplesPerSecond) {
    if (!(samplesPerSecond > 0.0) || !std::isfinite(samplesPerSecond))
        throw Error("sampled clip: " + std::to_string(samplesPerSecond) +
                    " samples a second, expected more than 0");
    BoneSampler sampler(animation, skeleton);
    const double seconds = sampler.duration();
    const double steps = seconds * samplesPerSecond; // whole ones, as floats round them
    const double samples = std::max(1.0, std::ceil(steps - std::min(0.01, 1e-6 * (1.0 + steps))));
    const double joints = static_cast<double>(sampler.joints().size());
    if (!(samples * joints <= kMostJointSamples)) // for NaN, too
        throw Error("sampled clip: animation \"" + animation.getName() + "\" of " +
                    std::to_string(seconds) +
                    " s has more than 10,000,000 samples of all joints together");
    const osg::ref_ptr<SampledClip> result = new SampledClip;
    result->_name = animation.getName();
    result->_joints = sampler.joints();
    result->_step = seconds > 0.0 ? seconds / samples : 1.0 / samplesPerSecond;
    for (double i = 0.0; i < samples; i += 1.0) sampler.append(i * result->_step, result->_samples);
    result->findRoot();
    return result;
}

void SampledClip::findRoot() {
    for (std::size_t j = 0; j < _joints.size(); ++j)
        for (std::size_t f = 1; f < sampleCount(); ++f)
            if (glm::distance(sample(f)[j].translation, sample(0)[j].translation) > 1e-9) {
                _root = j;
                return;
            }
}

int SampledClip::find(const std::string& joint) const {
    for (std::size_t j = 0; j < _joints.size(); ++j)
        if (_joints[j].name == joint) return static_cast<int>(j);
    return -1;
}

SampledClip::Place SampledClip::place(double time, bool loop) const noexcept {
    const std::size_t count = sampleCount();
    double at = time / _step;
    if (!std::isfinite(at)) at = 0.0;
    // A sample's own time is that sample, whatever rounding did to it: osgAnimation's keys have
    // their times in single precision.
    if (std::abs(at - std::round(at)) < 1e-5) at = std::round(at);
    const auto whole = static_cast<double>(count);
    if (!loop) {
        at = std::clamp(at, 0.0, whole - 1.0);
    } else {
        at -= whole * std::floor(at / whole);
        if (at >= whole) at = 0.0;
    }
    Place result;
    result.from = std::min(static_cast<std::size_t>(at), count - 1);
    result.share = at - static_cast<double>(result.from);
    result.to = result.share > 0.0 ? (result.from + 1) % count : result.from;
    return result;
}

void SampledClip::evaluate(double time, bool loop, JointSample* joints) const noexcept {
    const Place at = place(time, loop);
    const JointSample* from = sample(at.from);
    const JointSample* to = sample(at.to);
    const SampleBlend blended(at.share);
    for (std::size_t j = 0; j < _joints.size(); ++j) joints[j] = blended(from[j], to[j]);
}

} // namespace osgSkin
