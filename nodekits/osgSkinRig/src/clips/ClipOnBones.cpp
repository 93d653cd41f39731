// SPDX-License-Identifier: MIT
#include "clips/ClipOnBones.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

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
    std::vector<Matrices> result(_rig.joints.size());
    std::vector<osg::Matrixd> inRest(
        _rig.joints.size()); // in skeleton space, with rest space's axes
    for (std::size_t j = 0; j < _rig.joints.size(); ++j) {
        const RestJoint& joint = _rig.joints[j];
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dvec3 offset = joint.parent < 0 ? _clip.rootPositions[frame]
                                                   : joint.centre - _rig.joints[parent].centre;
        const glm::dquat& rotation = _clip.rotations[frame * _clip.joints + j];
        const osg::Matrixd local =
            osg::Matrixd::rotate(toOsg(rotation)) * osg::Matrixd::translate(toOsg(offset));
        inRest[j] = joint.parent < 0 ? local : local * inRest[parent];
        result[j] = {_axes[j] * inRest[j], local};
    }
    // Children may come before the bone above them, where the skeleton's tree is not the rig's.
    for (std::size_t j = 0; j < result.size(); ++j) {
        const int above = _above[j];
        const bool asInRig = above == _rig.joints[j].parent && _axes[j].isIdentity() &&
                             _between[j].isIdentity() &&
                             (above < 0 || _axes[static_cast<std::size_t>(above)].isIdentity());
        if (asInRig) continue;
        const osg::Matrixd outer =
            above < 0 ? _between[j]
                      : _between[j] * result[static_cast<std::size_t>(above)].inSkeleton;
        result[j].local = result[j].inSkeleton * osg::Matrixd::inverse(outer);
    }
    return result;
}

} // namespace osgSkin
