// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Bone>

namespace osgSkin {

/// Keeps a matrix in the bone's update callback too: an update traversal sets the bone from there.
///
/// \param local from the bone to its parent
/// \return false, and the callback is as it was, where its stack is neither a translation and a
///         rotation, with a scale where the matrix has one, nor one matrix; true where the bone has
///         no such callback
bool holdInCallback(osgAnimation::Bone& bone, const osg::Matrixd& local);

} // namespace osgSkin
