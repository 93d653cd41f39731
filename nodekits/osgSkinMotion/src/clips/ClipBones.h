// SPDX-License-Identifier: MIT
#ifndef OSGSKINMOTION_CLIPS_CLIPBONES_H
#define OSGSKINMOTION_CLIPS_CLIPBONES_H

#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>

#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <vector>

namespace osgSkin {

/// Throws osgSkin::Error where the clip is empty, has no positive frame time, or was not made for a
/// rig of this many joints.
void requireFits(const Clip& clip, const RestSkeleton& rig);

/// Also throws where rotations are not unit, or the root is beyond -1e18 to 1e18.
void requireUsable(const Clip& clip, const RestSkeleton& rig);

/// The elements of an update callback that can hold any pose of its bone: a translation and a
/// rotation, perhaps with a scale after them, or one matrix. The others are null.
struct HoldingElements {
    osgAnimation::StackedTranslateElement* translate = nullptr;
    osgAnimation::StackedQuaternionElement* rotate = nullptr;
    osgAnimation::StackedScaleElement* scale = nullptr;
    osgAnimation::StackedMatrixElement* matrix = nullptr;

    /// \return false where the stack has other elements, such as rotations about axes; the members
    ///        are then not usable
    bool find(osgAnimation::UpdateBone& update);
};

/// The bones of a skeleton, parents before children; not those of another skeleton below it.
std::vector<osg::ref_ptr<osgAnimation::Bone>> bonesInOrder(osgAnimation::Skeleton& skeleton);

/// The update callback that moves a bone, which may be nested in others; null where there is none.
osgAnimation::UpdateBone* updateOf(osgAnimation::Bone& bone);

/// Whether a scale differs from 1 by more than rounding.
bool isScaled(const osg::Vec3d& scale);

/// Writes a bone's matrix to its update callback too, from which update traversals set the bone.
///
/// \param local from the bone to its parent
/// \return false, with the callback unchanged, where it has no HoldingElements, or none for the
///        matrix's scale; true where the bone has no such callback
bool writeToUpdateCallback(osgAnimation::Bone& bone, const osg::Matrixd& local);

} // namespace osgSkin

#endif
