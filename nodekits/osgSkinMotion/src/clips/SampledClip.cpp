// SPDX-License-Identifier: MIT
#include <osgSkinMotion/SampledClip>

#include "clips/BakedClip.h"
#include "clips/ClipBones.h"
#include "clips/JointMaps.h"

#include <osgSkin/Binding>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/Pose>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/FindJoint>

#include <glm/geometric.hpp>
#include <osg/NodeVisitor>
#include <osgAnimation/Bone>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace osgSkin {
namespace {

/// Plays an animation on copies of the update callbacks of a skeleton's bones. The skeleton does
/// not change.
class BoneSampler {
public:
    /// \throw osgSkin::Error where the skeleton has no bone
    BoneSampler(const osgAnimation::Animation& animation, osgAnimation::Skeleton& skeleton);

    double duration() const { return _animation->getDuration() / _speed; } ///< seconds
    std::vector<SampledClip::Joint> joints() const;

    /// Adds the joints' transforms relative to their parents at a time.
    /// \throw osgSkin::Error where a bone's matrix cannot be used
    void append(double time, std::vector<JointSample>& samples);

private:
    void constrain(std::vector<osg::Matrixd>& inSkeleton);

    osg::ref_ptr<osgAnimation::Animation> _animation;             ///< with its keys' own duration
    double _speed;                                                ///< keySpeed()
    std::vector<osg::ref_ptr<osgAnimation::Bone>> _bones;         ///< parents before children
    std::vector<osg::ref_ptr<osgAnimation::UpdateBone>> _updates; ///< a bone each, or null
    std::vector<BoundJoint> _joints;
    Pose _pose;
    osg::ref_ptr<Constraints> _constraints;            ///< null where there are none
    osg::ref_ptr<osgAnimation::Skeleton> _constrained; ///< copies of the bones, for these
    std::vector<osg::ref_ptr<osgAnimation::Bone>> _constrainedBones;
};

/// A copy of a bone's update callback, linked with an animation's channels; null where there is
/// none. The bone itself does not move.
osg::ref_ptr<osgAnimation::UpdateBone> copyOfUpdate(osgAnimation::Bone& bone,
                                                    osgAnimation::Animation& animation) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    if (!update) return nullptr;
    const osg::ref_ptr<osgAnimation::UpdateBone> copy =
        osg::clone(update, osg::CopyOp::SHALLOW_COPY);
    osgAnimation::AnimationUpdateCallbackBase& linked = *copy; // UpdateBone hides its link()
    if (!copy->getName().empty()) linked.link(&animation);
    return copy;
}

osg::Matrixd matrixOf(const osgAnimation::Bone& bone, osgAnimation::UpdateBone* update) {
    if (!update) return bone.getMatrix();
    update->getStackedTransforms().update(0.0f);
    return update->getStackedTransforms().getMatrix();
}

BoneSampler::BoneSampler(const osgAnimation::Animation& animation, osgAnimation::Skeleton& skeleton)
    : _animation(osg::clone(&animation, osg::CopyOp::DEEP_COPY_ALL)), _speed(keySpeed(animation)) {
    _bones = bonesInOrder(skeleton);
    if (_bones.empty())
        throw Error("sampled clip: the skeleton \"" + skeleton.getName() + "\" has no bone");
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : _bones)
        _updates.push_back(copyOfUpdate(*bone, *_animation));
    _animation->computeDuration();
    // A pose has one root: add one, at rest, above all bones without a parent bone.
    const glm::dvec3 up(0.0, 0.0, 1.0);
    _joints.push_back({"", -1, glm::dvec3(0.0), up, up});
    std::unordered_map<const osgAnimation::Bone*, int> joints = {{nullptr, 0}};
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : _bones) {
        const auto above = joints.find(bone->getBoneParent());
        const osg::Matrixd bind = osg::Matrixd::inverse(bone->getInvBindMatrixInSkeletonSpace());
        joints.emplace(bone, static_cast<int>(_joints.size()));
        _joints.push_back({bone->getName(), above == joints.end() ? 0 : above->second,
                           toGlm(bind.getTrans()), up, up});
    }
    _pose = Pose(_joints);
    const Constraints* const constraints = find<Constraints>(skeleton);
    if (!constraints) return;
    _constraints = new Constraints(constraints->get());
    _constrained = new osgAnimation::Skeleton;
    for (std::size_t j = 1; j < _joints.size(); ++j) {
        const osg::ref_ptr<osgAnimation::Bone> copy = new osgAnimation::Bone(_joints[j].name);
        copy->setInvBindMatrixInSkeletonSpace(_bones[j - 1]->getInvBindMatrixInSkeletonSpace());
        const auto parent = static_cast<std::size_t>(_joints[j].parent);
        osg::Group* above = _constrained;
        if (parent > 0) above = _constrainedBones[parent - 1];
        above->addChild(copy);
        _constrainedBones.push_back(copy);
    }
}

/// Rotates constrained bones, and moves those below.
/// \param inSkeleton matrices of the joints
void BoneSampler::constrain(std::vector<osg::Matrixd>& inSkeleton) {
    for (std::size_t j = 1; j < inSkeleton.size(); ++j) {
        osgAnimation::Bone& bone = *_constrainedBones[j - 1];
        bone.setMatrixInSkeletonSpace(inSkeleton[j]);
        const auto parent = static_cast<std::size_t>(_joints[j].parent);
        bone.setMatrix(inSkeleton[j] * osg::Matrixd::inverse(inSkeleton[parent]));
    }
    _constraints->apply(*_constrained);
    for (std::size_t j = 1; j < inSkeleton.size(); ++j)
        inSkeleton[j] = _constrainedBones[j - 1]->getMatrixInSkeletonSpace();
}

std::vector<SampledClip::Joint> BoneSampler::joints() const {
    std::vector<SampledClip::Joint> result;
    for (std::size_t j = 1; j < _joints.size(); ++j)
        result.push_back({_joints[j].name, _joints[j].parent - 1, _joints[j].centre});
    return result;
}

void BoneSampler::append(double time, std::vector<JointSample>& samples) {
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _animation->getChannels())
        if (channel->getTarget()) channel->getTarget()->reset();
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _animation->getChannels())
        channel->update(time * _speed, 1.0f, 0);
    std::vector<osg::Matrixd> inSkeleton(_joints.size());
    for (std::size_t j = 1; j < _joints.size(); ++j)
        inSkeleton[j] = matrixOf(*_bones[j - 1], _updates[j - 1].get()) *
                        inSkeleton[static_cast<std::size_t>(_joints[j].parent)];
    if (_constraints) constrain(inSkeleton);
    std::vector<glm::dmat4> skinning = {glm::dmat4(1.0)};
    for (std::size_t j = 1; j < _joints.size(); ++j)
        skinning.push_back(toGlm(_bones[j - 1]->getInvBindMatrixInSkeletonSpace() * inSkeleton[j]));
    if (!_pose.set(skinning.data(), skinning.size()))
        throw Error("sampled clip: animation \"" + _animation->getName() +
                    "\" makes a bone's matrix singular or not finite");
    for (std::size_t j = 1; j < _joints.size(); ++j) {
        const JointTransform own = _pose.transform(j);
        samples.push_back({own.rotation, own.translation, own.scale});
    }
}

/// Limit for all joints together, 640 MB: 100 joints for half an hour.
constexpr double kMaxJointSamples = 1e7;

} // namespace

JointSample blend(const JointSample& a, const JointSample& b, double share) noexcept {
    return SampleBlend(share)(a, b);
}

std::vector<std::string> jointsBelow(const SampledClip& clip, const std::string& joint) {
    std::size_t top = 0;
    try {
        top = findJoint(restOf(clip), joint);
    } catch (const Error& error) {
        throw Error("sampled clip \"" + clip.name() + "\": " + error.what());
    }
    std::vector<std::string> result;
    std::vector<bool> isBelow;
    for (const SampledClip::Joint& each : clip.joints()) {
        isBelow.push_back(isBelow.size() == top ||
                          (each.parent >= 0 && isBelow[static_cast<std::size_t>(each.parent)]));
        if (isBelow.back()) result.push_back(each.name);
    }
    return result;
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
    for (const auto& [j, positions] : clip.moves) {
        const RestJoint& joint = rig.joints[j];
        const glm::dvec3 rest =
            joint.centre - rig.joints[static_cast<std::size_t>(joint.parent)].centre;
        for (std::size_t f = 0; f < clip.frames; ++f)
            result->_samples[f * clip.joints + j].translation = positions[f] - rest;
    }
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
    if (!(samples * joints <= kMaxJointSamples)) // for NaN, too
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

osg::ref_ptr<const SampledClip> SampledClip::create(const std::string& name,
                                                    std::vector<Joint> joints,
                                                    std::vector<JointSample> samples, double step) {
    const auto fail = [&name](const std::string& what) {
        throw Error("sampled clip \"" + name + "\": " + what);
    };
    if (joints.empty()) fail("no joint");
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].parent < -1 || joints[j].parent >= static_cast<int>(j))
            fail("the parent of joint " + std::to_string(j) + " does not precede it");
    if (samples.empty() || samples.size() % joints.size() != 0)
        fail(std::to_string(samples.size()) + " samples of " + std::to_string(joints.size()) +
             " joints");
    if (!(step > 0.0) || !std::isfinite(step)) fail("the step is not above 0");
    for (JointSample& sample : samples) {
        const double length = glm::length(sample.rotation);
        if (!(std::abs(length - 1.0) < 1e-3) || !(sample.scale > 0.0) ||
            sample.scale > kLargestCoordinate || !isInRange(sample.translation))
            fail("a sample that is no transform");
        sample.rotation /= length;
    }
    const osg::ref_ptr<SampledClip> result = new SampledClip;
    result->_name = name;
    result->_joints = std::move(joints);
    result->_samples = std::move(samples);
    result->_step = step;
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

SampledClip::Interval SampledClip::intervalAt(double time, bool loop) const noexcept {
    const std::size_t count = sampleCount();
    double at = time / _step;
    if (!std::isfinite(at)) at = 0.0;
    // A sample's own time must give that sample in spite of rounding: osgAnimation's keys have
    // times in single precision.
    if (std::abs(at - std::round(at)) < 1e-5) at = std::round(at);
    const auto whole = static_cast<double>(count);
    if (!loop) {
        at = std::clamp(at, 0.0, whole - 1.0);
    } else {
        at -= whole * std::floor(at / whole);
        if (at >= whole) at = 0.0;
    }
    Interval result;
    result.from = std::min(static_cast<std::size_t>(at), count - 1);
    result.share = at - static_cast<double>(result.from);
    result.to = result.share > 0.0 ? (result.from + 1) % count : result.from;
    return result;
}

void SampledClip::evaluate(double time, bool loop, JointSample* joints) const noexcept {
    const Interval at = intervalAt(time, loop);
    const JointSample* from = sample(at.from);
    const JointSample* to = sample(at.to);
    const SampleBlend blended(at.share);
    for (std::size_t j = 0; j < _joints.size(); ++j) joints[j] = blended(from[j], to[j]);
}

} // namespace osgSkin
