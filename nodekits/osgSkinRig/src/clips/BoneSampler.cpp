// SPDX-License-Identifier: MIT
#include "clips/BoneSampler.h"

#include "bones/HoldInCallback.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinRig/MakeAnimation>

#include <osg/NodeVisitor>
#include <osgAnimation/UpdateBone>

#include <unordered_map>

namespace osgSkin {
namespace {

class BonesInOrder : public osg::NodeVisitor {
public:
    BonesInOrder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (getNodePath().size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) bones.emplace_back(bone);
        traverse(node);
    }

    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;
};

/// A copy of what moves a bone, linked with an animation's channels; null where nothing does. What
/// the animation does not move stays as it is, and what it does is not seen in the scene.
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

} // namespace

BoneSampler::BoneSampler(const osgAnimation::Animation& animation, osgAnimation::Skeleton& skeleton)
    : _animation(osg::clone(&animation, osg::CopyOp::DEEP_COPY_ALL)), _speed(keySpeed(animation)) {
    BonesInOrder found;
    skeleton.accept(found);
    _bones = found.bones;
    if (_bones.empty())
        throw Error("sampled clip: the skeleton \"" + skeleton.getName() + "\" has no bone");
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : _bones)
        _updates.push_back(copyOfUpdate(*bone, *_animation));
    _animation->computeDuration();
    // One root above all bones that have no bone above them, at rest: a pose has one root.
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
    std::vector<glm::dmat4> skinning = {glm::dmat4(1.0)};
    for (std::size_t j = 1; j < _joints.size(); ++j) {
        osgAnimation::Bone& bone = *_bones[j - 1];
        inSkeleton[j] = matrixOf(bone, _updates[j - 1].get()) *
                        inSkeleton[static_cast<std::size_t>(_joints[j].parent)];
        skinning.push_back(toGlm(bone.getInvBindMatrixInSkeletonSpace() * inSkeleton[j]));
    }
    if (!_pose.set(skinning.data(), skinning.size()))
        throw Error("sampled clip: animation \"" + _animation->getName() +
                    "\" makes a bone's matrix singular or not finite");
    for (std::size_t j = 1; j < _joints.size(); ++j) {
        const JointTransform own = _pose.transform(j);
        samples.push_back({own.rotation, own.translation, own.scale});
    }
}

} // namespace osgSkin
