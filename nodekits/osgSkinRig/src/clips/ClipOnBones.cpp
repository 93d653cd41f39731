// SPDX-License-Identifier: MIT
#include "clips/ClipOnBones.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinRig/ForwardKinematics>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

osg::Matrixd bindAxes(const osgAnimation::Bone& bone) {
    osg::Matrixd bind;
    const osg::Matrixd& inverse = bone.getInvBindMatrixInSkeletonSpace();
    if (!inverse.valid() || !bind.invert(inverse))
        throw Error("bone \"" + bone.getName() + "\": its inverse bind matrix cannot be inverted");
    bind.setTrans(osg::Vec3d());
    return bind;
}

} // namespace

ClipOnBones::ClipOnBones(const Clip& clip, const RestSkeleton& rig,
                         osgAnimation::Skeleton& skeleton)
    : _clip(clip), _rig(rig) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    std::map<const osgAnimation::Bone*, int> jointOf;
    // Without any inverse bind matrix the rig says how the bones stood (readSkeleton()).
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
    worldPositions(_rig, rotations, _clip.rootPositions[frame], positions);
    std::vector<Matrices> result(_rig.joints.size());
    for (std::size_t j = 0; j < result.size(); ++j)
        result[j].inSkeleton = _axes[j] * osg::Matrixd::rotate(toOsg(rotations[j])) *
                               osg::Matrixd::translate(toOsg(positions[j]));
    // Children may come before the bone above them, where the skeleton's tree is not the rig's.
    for (std::size_t j = 0; j < result.size(); ++j) {
        osg::Matrixd above = _between[j];
        if (_above[j] >= 0) above.postMult(result[static_cast<std::size_t>(_above[j])].inSkeleton);
        result[j].local = result[j].inSkeleton * osg::Matrixd::inverse(above);
    }
    return result;
}

} // namespace osgSkin
