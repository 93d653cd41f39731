// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Bone>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

namespace osgSkin {

/// The elements of an update callback that can hold any pose of its bone: a translation and a
/// rotation, perhaps with a scale after them, or one matrix. The others are null.
struct HoldingElements {
    osgAnimation::StackedTranslateElement* translate = nullptr;
    osgAnimation::StackedQuaternionElement* rotate = nullptr;
    osgAnimation::StackedScaleElement* scale = nullptr;
    osgAnimation::StackedMatrixElement* matrix = nullptr;

    /// \return false where the stack is another one, as of rotations about axes; what was found of
    ///         it then is of no use
    bool find(osgAnimation::UpdateBone& update);
};

/// What moves a bone, also where it stands behind other callbacks; null: nothing does.
osgAnimation::UpdateBone* updateOf(osgAnimation::Bone& bone);

/// Whether something is scaled by more than a rounding.
bool isScaled(const osg::Vec3d& scale);

/// Keeps a matrix in the bone's update callback too: an update traversal sets the bone from there.
///
/// \param local from the bone to its parent
/// \return false, and the callback is as it was, where it has no HoldingElements, or none for the
///         matrix's scale; true where the bone has no such callback
bool holdInCallback(osgAnimation::Bone& bone, const osg::Matrixd& local);

} // namespace osgSkin
