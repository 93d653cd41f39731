// SPDX-License-Identifier: MIT
#include <osgSkinMotion/MakeAnimation>

#include "clips/ClipBones.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkin/UpdateMorphs>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinMotion/Prop>
#include <osgSkinRig/Clip>
#include <osgSkinRig/ForwardKinematics>
#include <osgSkinRig/RestSkeleton>

#include <osg/Notify>
#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/Sampler>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// The channels of a bone's own update callback, for matrices relative to the parent bone.
class BoneChannels {
public:
    /// \throw osgSkin::Error where channels cannot give the bone any position and rotation: it has
    ///        no update callback, one without a name, or other elements than a named translation
    ///        and a named rotation, perhaps with a scale
    explicit BoneChannels(osgAnimation::Bone& bone);

    /// Adds a key to each.
    /// \throw osgSkin::Error where the matrix is scaled and there is no element for it
    void add(double time, const osg::Matrixd& local);

    const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels() const { return _channels; }

private:
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> _translate, _scale; ///< the latter may be null
    osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> _rotate;
    std::vector<osg::ref_ptr<osgAnimation::Channel>> _channels;
    std::string _bone;
    osg::Quat _last;
};

template <typename Made>
void make(const osgAnimation::UpdateBone& update, const osg::Object& element,
          osg::ref_ptr<Made>& channel, std::vector<osg::ref_ptr<osgAnimation::Channel>>& all) {
    channel = new Made;
    channel->setName(element.getName());
    channel->setTargetName(update.getName());
    all.emplace_back(channel);
}

template <typename Channel, typename Value>
void addKey(Channel& channel, double time, const Value& value) {
    auto* keys = channel.getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back({time, value});
}

BoneChannels::BoneChannels(osgAnimation::Bone& bone) : _bone(bone.getName()) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    HoldingElements held;
    const bool found = update && !update->getName().empty() && held.find(*update) && !held.matrix;
    if (!found || held.translate->getName().empty() || held.rotate->getName().empty() ||
        (held.scale && held.scale->getName().empty()))
        throw Error("bone \"" + _bone +
                    "\" cannot be moved by channels, expected a named update callback with a named "
                    "translation and a named rotation, perhaps a scale, and nothing else");
    make(*update, *held.translate, _translate, _channels);
    make(*update, *held.rotate, _rotate, _channels);
    if (held.scale) make(*update, *held.scale, _scale, _channels);
}

void BoneChannels::add(double time, const osg::Matrixd& local) {
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    local.decompose(translation, rotation, scale, scaleAxes);
    if (!_scale && isScaled(scale))
        throw Error("bone \"" + _bone +
                    "\" is scaled against the bone above, expected an element for its scale");
    // q and -q are the same rotation; the nearer one makes the interpolation take the short arc.
    if (_last.asVec4() * rotation.asVec4() < 0.0) rotation = -rotation;
    _last = rotation;
    addKey(*_translate, time, osg::Vec3(translation));
    addKey(*_rotate, time, rotation);
    if (_scale) addKey(*_scale, time, osg::Vec3(scale));
}

/// Calls `add(sample, time)` for each key. The last sample is held for one frame's time, so that
/// every sample gets its share of the loop, none lies at the loop's end (where osgAnimation, whose
/// duration is a float, shows the first), and a single sample has a duration.
template <typename Add>
void forEachKey(const Clip& clip, const Add& add) {
    for (std::size_t f = 0; f <= clip.frames; ++f)
        add(std::min(f, clip.frames - 1), static_cast<double>(f) * clip.frameTime);
}

/// A joint's rotations as a channel "quaternion" without a target.
osg::ref_ptr<osgAnimation::Channel> rotationChannel(const Clip& clip, std::size_t joint) {
    osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    channel->setName("quaternion");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    glm::dquat previous(1.0, 0.0, 0.0, 0.0);
    forEachKey(clip, [&](std::size_t sample, double time) {
        // q and -q are the same rotation; the nearer one makes the interpolation take the short
        // arc.
        glm::dquat q = clip.rotations[sample * clip.joints + joint];
        if (glm::dot(previous, q) < 0.0) q = -q;
        keys->push_back(osgAnimation::QuatKeyframe(time, toOsg(q)));
        previous = q;
    });
    return channel;
}

/// A joint's positions as a channel "translate" without a target.
osg::ref_ptr<osgAnimation::Channel> positionChannel(const Clip& clip,
                                                    const std::vector<glm::dvec3>& positions) {
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel = new osgAnimation::Vec3LinearChannel;
    channel->setName("translate");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    forEachKey(clip, [&](std::size_t sample, double time) {
        keys->push_back(osgAnimation::Vec3Keyframe(time, osg::Vec3(toOsg(positions[sample]))));
    });
    return channel;
}

/// Adds the channels of a clip's morph targets, for an UpdateMorphs.
void addMorphs(const Clip& clip, osgAnimation::Animation& animation) {
    for (const auto& [morph, weights] : clip.morphs) {
        const osg::ref_ptr<osgAnimation::FloatLinearChannel> channel =
            new osgAnimation::FloatLinearChannel;
        channel->setName(morph);
        channel->setTargetName(UpdateMorphs::kName);
        forEachKey(clip, [&, &of = weights](std::size_t sample, double time) {
            addKey(*channel, time, of[sample]);
        });
        animation.getChannels().push_back(channel);
    }
}

/// Computes the matrices of a skeleton's bones in a clip's frames; bones may have axes of their own
/// in the bind pose. Moves nothing. Clip and rig must not change meanwhile.
class ClipOnBones {
public:
    struct Matrices {
        osg::Matrixd inSkeleton;
        osg::Matrixd local; ///< to the parent bone
    };

    /// \param clip fits the rig
    /// \throw osgSkin::Error where a bone's inverse bind matrix cannot be inverted
    ClipOnBones(const Clip& clip, const RestSkeleton& rig, osgAnimation::Skeleton& skeleton);

    /// The bone of a joint, null where the skeleton has none.
    osgAnimation::Bone* bone(std::size_t joint) const { return _bones[joint].get(); }

    /// A frame's matrices, one pair per joint; undefined for joints without a bone.
    /// \param frame less than the clip's
    std::vector<Matrices> frame(std::size_t frame) const;

private:
    const Clip& _clip;
    const RestSkeleton& _rig;
    std::vector<osg::ref_ptr<osgAnimation::Bone>> _bones;
    /// From a bone's own axes in the bind pose to rest space, in which clips are: the identity for
    /// bones of makeSkeleton().
    std::vector<osg::Matrixd> _axes;
    std::vector<int> _above; ///< the joint of the nearest ancestor bone that has one, or -1
    std::vector<osg::Matrixd>
        _between; ///< to that bone, from the current matrices of the bones between
};

osg::Matrixd bindAxes(const osgAnimation::Bone& bone) {
    osg::Matrixd bind;
    const osg::Matrixd& inverse = bone.getInvBindMatrixInSkeletonSpace();
    if (!inverse.valid() || !bind.invert(inverse))
        throw Error("bone \"" + bone.getName() + "\": its inverse bind matrix cannot be inverted");
    bind.setTrans(osg::Vec3d());
    return bind;
}

ClipOnBones::ClipOnBones(const Clip& clip, const RestSkeleton& rig,
                         osgAnimation::Skeleton& skeleton)
    : _clip(clip), _rig(rig) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    std::map<const osgAnimation::Bone*, int> jointOf;
    // Without any inverse bind matrix the rig has the bones' bind pose (readSkeleton()).
    const bool bound = std::any_of(bones.begin(), bones.end(), [](const auto& named) {
        return !named.second->getInvBindMatrixInSkeletonSpace().isIdentity();
    });
    for (const RestJoint& joint : rig.joints) {
        const auto found = bones.find(joint.name);
        _bones.push_back(found == bones.end() ? nullptr : found->second);
        _axes.push_back(!_bones.back() ? osg::Matrixd()
                        : bound        ? bindAxes(*_bones.back())
                                       : osg::Matrixd::rotate(toOsg(joint.frame)));
        if (_bones.back()) jointOf[_bones.back()] = static_cast<int>(_bones.size()) - 1;
    }
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : _bones) {
        _above.push_back(-1);
        _between.emplace_back();
        osgAnimation::Bone* next = bone ? bone->getBoneParent() : nullptr;
        for (; next; next = next->getBoneParent()) {
            const auto found = jointOf.find(next);
            if (found != jointOf.end()) {
                _above.back() = found->second;
                break;
            }
            _between.back().postMult(next->getMatrix());
        }
    }
}

std::vector<ClipOnBones::Matrices> ClipOnBones::frame(std::size_t frame) const {
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> positions;
    worldRotations(_rig, &_clip.rotations[frame * _clip.joints], rotations);
    worldPositions(_rig, rotations, _clip.rootPositions[frame], _clip.moves, frame, positions);
    std::vector<Matrices> result(_rig.joints.size());
    for (std::size_t j = 0; j < result.size(); ++j)
        result[j].inSkeleton = _axes[j] * osg::Matrixd::rotate(toOsg(rotations[j])) *
                               osg::Matrixd::translate(toOsg(positions[j]));
    // A child may precede its parent bone where the skeleton's tree differs from the rig's.
    for (std::size_t j = 0; j < result.size(); ++j) {
        osg::Matrixd above = _between[j];
        if (_above[j] >= 0) above.postMult(result[static_cast<std::size_t>(_above[j])].inSkeleton);
        result[j].local = result[j].inSkeleton * osg::Matrixd::inverse(above);
    }
    return result;
}

} // namespace

void applyFrame(const Clip& clip, const RestSkeleton& rig, std::size_t frame,
                osgAnimation::Skeleton& skeleton) {
    requireFits(clip, rig);
    if (frame >= clip.frames)
        throw Error("clip \"" + clip.name + "\": no frame " + std::to_string(frame) +
                    ", expected less than " + std::to_string(clip.frames));
    if (UpdatePlayedSkeleton* played = UpdatePlayedSkeleton::of(skeleton)) played->poseBones();
    const ClipOnBones bones(clip, rig, skeleton);
    const std::vector<ClipOnBones::Matrices> posed = bones.frame(frame);
    std::string notHeld;
    for (std::size_t j = 0; j < posed.size(); ++j) {
        osgAnimation::Bone* bone = bones.bone(j);
        if (!bone) continue;
        bone->setMatrix(posed[j].local);
        bone->setMatrixInSkeletonSpace(posed[j].inSkeleton);
        if (!writeToUpdateCallback(*bone, posed[j].local) && notHeld.empty())
            notHeld = bone->getName();
    }
    if (!notHeld.empty())
        OSG_WARN << onOneLine("osgSkin: applyFrame(): bone \"" + notHeld + "\" of skeleton \"" +
                              skeleton.getName() +
                              "\" goes back to its own pose at the next update: expected an update "
                              "callback of one translation and one rotation, or of one matrix")
                 << std::endl;
}

osg::ref_ptr<osgAnimation::Animation> makeAnimation(const Clip& clip, const RestSkeleton& rig) {
    requireUsable(clip, rig);
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setName(clip.name);
    animation->setPlayMode(osgAnimation::Animation::LOOP);

    osg::ref_ptr<osgAnimation::Channel> root = positionChannel(clip, clip.rootPositions);
    root->setTargetName(rig.joints[0].name);
    // addChannel() would search all other channels.
    animation->getChannels().push_back(root);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        osg::ref_ptr<osgAnimation::Channel> channel = rotationChannel(clip, j);
        channel->setTargetName(rig.joints[j].name);
        animation->getChannels().push_back(channel);
    }
    for (const auto& [joint, positions] : clip.moves) {
        osg::ref_ptr<osgAnimation::Channel> channel = positionChannel(clip, positions);
        channel->setTargetName(rig.joints[joint].name);
        animation->getChannels().push_back(channel);
    }
    addMorphs(clip, *animation);
    animation->computeDuration();
    return animation;
}

osg::ref_ptr<osgAnimation::Animation> makeAnimation(const Clip& clip, const RestSkeleton& rig,
                                                    osgAnimation::Skeleton& skeleton) {
    requireUsable(clip, rig);
    const ClipOnBones bones(clip, rig, skeleton);
    std::vector<std::pair<std::size_t, BoneChannels>> moved;
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (osgAnimation::Bone* bone = bones.bone(j)) moved.emplace_back(j, *bone);
    for (std::size_t f = 0; f <= clip.frames; ++f) { // the last is held
        const auto posed = bones.frame(std::min(f, clip.frames - 1));
        for (auto& [joint, channels] : moved)
            channels.add(static_cast<double>(f) * clip.frameTime, posed[joint].local);
    }
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setName(clip.name);
    animation->setPlayMode(osgAnimation::Animation::LOOP);
    for (const auto& [joint, channels] : moved)
        for (const auto& channel : channels.channels()) animation->getChannels().push_back(channel);
    addMorphs(clip, *animation);
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

namespace {

/// The prop's motion in skeleton space, as a clip of one joint.
Clip inSkeletonSpace(const Motion& motion, const RetargetReport& report) {
    Clip clip;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = 1;
    for (std::size_t frame = 0; frame < motion.frames; ++frame) {
        clip.rotations.push_back(report.rotation * motion.rotation(frame, 0));
        clip.rootPositions.push_back(
            report.scale * (report.rotation * motion.rootPositions[frame]) + report.offset);
    }
    return clip;
}

} // namespace

osg::ref_ptr<osg::MatrixTransform> makeProp(const std::string& name,
                                            const std::vector<MeshPart>& parts,
                                            const Motion& motion, const RetargetReport& report,
                                            osgAnimation::Animation& animation) {
    motion.validate();
    const Clip clip = inSkeletonSpace(motion, report);
    for (const glm::dvec3& position : clip.rootPositions)
        if (!isInRange(position))
            throw Error("prop \"" + name +
                        "\": a place in the figure's space is not finite, or "
                        "beyond -1e18 to 1e18");
    osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
    node->setName(name);
    node->setDataVariance(osg::Object::DYNAMIC);
    const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> update =
        new osgAnimation::UpdateMatrixTransform(name);
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedTranslateElement("translate", osg::Vec3()));
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
    node->setUpdateCallback(update);
    for (const MeshPart& part : parts) node->addChild(part.geometry);

    // Its position before the first update.
    node->setMatrix(osg::Matrix::rotate(toOsg(clip.rotations[0])) *
                    osg::Matrix::translate(toOsg(clip.rootPositions[0])));
    for (const auto& channel :
         {positionChannel(clip, clip.rootPositions), rotationChannel(clip, 0)}) {
        channel->setTargetName(name);
        animation.addChannel(channel);
    }
    return node;
}

} // namespace osgSkin
