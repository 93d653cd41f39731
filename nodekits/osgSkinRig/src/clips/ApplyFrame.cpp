// SPDX-License-Identifier: MIT
#include <osgSkinRig/ApplyFrame>

#include "clips/ClipCheck.h"
#include "clips/HoldInCallback.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/Notify>
#include <osgAnimation/Bone>

#include <map>
#include <vector>

namespace osgSkin {
namespace {

/// From a bone's own axes in the bind pose to rest space, which clips are told in, without a
/// translation: the identity for makeSkeleton()'s bones.
osg::Matrixd bindAxes(const osgAnimation::Bone& bone) {
    osg::Matrixd bind;
    const osg::Matrixd& inverse = bone.getInvBindMatrixInSkeletonSpace();
    if (!inverse.valid() || !bind.invert(inverse))
        throw Error("bone \"" + bone.getName() + "\": its inverse bind matrix cannot be inverted");
    bind.setTrans(osg::Vec3d());
    return bind;
}

/// The bones that a frame has posed, in skeleton space.
class PosedBones {
public:
    /// Poses a bone whose parents have been posed.
    void add(osgAnimation::Bone& bone, const osg::Matrixd& inSkeleton, const osg::Matrixd& local) {
        bone.setMatrix(local);
        bone.setMatrixInSkeletonSpace(inSkeleton);
        _inSkeleton[&bone] = inSkeleton;
    }

    /// Where a bone is now; those that were not posed follow the next that was.
    osg::Matrixd of(osgAnimation::Bone* bone) const {
        if (!bone) return {};
        const auto found = _inSkeleton.find(bone);
        return found != _inSkeleton.end() ? found->second
                                          : bone->getMatrix() * of(bone->getBoneParent());
    }

private:
    std::map<const osgAnimation::Bone*, osg::Matrixd> _inSkeleton;
};

} // namespace

void applyFrame(const Clip& clip, const RestSkeleton& rig, std::size_t frame,
                osgAnimation::Skeleton& skeleton) {
    requireFits(clip, rig);
    if (frame >= clip.frames)
        throw Error("clip \"" + clip.name + "\": no frame " + std::to_string(frame) +
                    ", expected less than " + std::to_string(clip.frames));
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    std::vector<osg::ref_ptr<osgAnimation::Bone>> boneOf(rig.joints.size());
    std::vector<osg::Matrixd> axes(rig.joints.size());
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const auto found = bones.find(rig.joints[j].name);
        if (found == bones.end()) continue;
        boneOf[j] = found->second;
        axes[j] = bindAxes(*boneOf[j]);
    }

    PosedBones posed;
    std::vector<osg::Matrixd> inSkeleton(rig.joints.size()); // with rest space's axes
    std::string notHeld;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const RestJoint& joint = rig.joints[j];
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dvec3 offset =
            joint.parent < 0 ? clip.rootPositions[frame] : joint.centre - rig.joints[parent].centre;
        const glm::dquat& rotation = clip.rotations[frame * clip.joints + j];
        osg::Matrixd local =
            osg::Matrixd::rotate(toOsg(rotation)) * osg::Matrixd::translate(toOsg(offset));
        inSkeleton[j] = joint.parent < 0 ? local : local * inSkeleton[parent];
        if (!boneOf[j]) continue;
        osgAnimation::Bone* above = boneOf[j]->getBoneParent();
        const bool plain =
            axes[j].isIdentity() &&
            (joint.parent < 0 ? above == nullptr
                              : above == boneOf[parent] && axes[parent].isIdentity());
        const osg::Matrixd turned = axes[j] * inSkeleton[j];
        if (!plain) local = turned * osg::Matrixd::inverse(posed.of(above));
        posed.add(*boneOf[j], turned, local);
        if (!holdInCallback(*boneOf[j], local) && notHeld.empty()) notHeld = joint.name;
    }
    if (!notHeld.empty())
        OSG_WARN << onOneLine("osgSkin: applyFrame(): bone \"" + notHeld + "\" of skeleton \"" +
                              skeleton.getName() +
                              "\" goes back to its own pose at the next update: expected an update "
                              "callback of one translation and one rotation, or of one matrix")
                 << std::endl;
}

} // namespace osgSkin
