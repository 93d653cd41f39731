// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVHMOTION_H
#define OSGSKINIMPORT_BVHMOTION_H 1

#include "bvh/BvhFile.h"

#include <osgSkinRig/Motion>

#include <string>

namespace osgSkin {

/// The joints in the zero pose, the root at its offset. A joint without children has its first End
/// Site for a tip.
RestSkeleton makeRestSkeleton(const BvhFile& file);

/// The motion of a file: a joint's rotations multiplied in the order of its channels, exact to
/// double precision. Of positions, those of the root are used, or of the joint that
/// rootMotionJoint() finds; moves of others are left out, with a notice.
/// \param path of the file, for the notice
Motion makeMotion(const BvhFile& file, const std::string& path);

} // namespace osgSkin

#endif
