// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>

#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <vector>

namespace osgSkin {

/// What a clip's frames make of a skeleton's bones, which may have axes of their own in the bind
/// pose. The clip and the rig stay as they are meanwhile; nothing is moved.
class ClipOnBones {
public:
    struct Matrices {
        osg::Matrixd inSkeleton;
        osg::Matrixd local; ///< to the bone above
    };

    /// \param clip fits the rig
    /// \throw osgSkin::Error where a bone's inverse bind matrix cannot be inverted
    ClipOnBones(const Clip& clip, const RestSkeleton& rig, osgAnimation::Skeleton& skeleton);

    /// The bone of a joint, null where the skeleton has none.
    osgAnimation::Bone* bone(std::size_t joint) const { return _bones[joint].get(); }

    /// A frame's matrices, one pair a joint; nothing of use for joints without a bone.
    /// \param frame less than the clip's
    std::vector<Matrices> frame(std::size_t frame) const;

private:
    const Clip& _clip;
    const RestSkeleton& _rig;
    std::vector<osg::ref_ptr<osgAnimation::Bone>> _bones;
    /// From a bone's own axes in the bind pose to rest space, which clips are told in: the identity
    /// for makeSkeleton()'s bones.
    std::vector<osg::Matrixd> _axes;
    std::vector<int> _above;            ///< the joint of the next bone above that has one, -1: none
    std::vector<osg::Matrixd> _between; ///< to that bone, of the bones between, as they stand
};

} // namespace osgSkin
