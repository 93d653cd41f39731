// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVHMOTION_H
#define OSGSKINIMPORT_BVHMOTION_H 1

#include "bvh/BvhFile.h"

#include <osgSkinRig/Motion>

#include <string>

namespace osgSkin {

/// The joints in the zero pose, with the root at its offset. The tip of a joint without children is
/// its first End Site.
RestSkeleton makeRestSkeleton(const BvhFile& file);

/// The motion of a file, with a joint's rotations multiplied in the order of its channels, in
/// double precision. Uses the positions of the root only, or of the joint that rootMotionJoint()
/// finds; those of other joints are dropped, with a notice.
/// \param file as read
/// \param path of the file, for the notice
Motion makeMotion(const BvhFile& file, const std::string& path);

} // namespace osgSkin

#endif
