// SPDX-License-Identifier: MIT
#pragma once

#include "reference/SameSkeleton.h"

#include <osgSkinRig/Clip>
#include <osgSkinRig/Motion>

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// The motion on a rig of the same skeleton: local rotations as they are, the root's positions in
/// the rig's unit.
/// \param motion its rotations count from its own zero pose
/// \param rig at rest
/// \param motionJoint [rig joint] which joint of the motion drives it, -1 for none
/// \param same what both skeletons have to do with each other
/// \param offset set to what the scaled root motion is moved by
Clip copyRotations(const Motion& motion, const RestSkeleton& rig,
                   const std::vector<int>& motionJoint, const SameSkeleton& same,
                   glm::dvec3& offset);

} // namespace osgSkin
