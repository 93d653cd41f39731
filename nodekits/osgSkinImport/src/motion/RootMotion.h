// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ROOTMOTION_H
#define OSGSKINIMPORT_ROOTMOTION_H 1

#include <osgSkinRig/RestSkeleton>

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Whether a joint's position differs from the one it has at rest, beyond what rounding explains.
bool isMoved(const glm::dvec3& position, const glm::dvec3& atRest);

/// The joint whose position carries the figure: the root, or the last that moves of those that
/// follow it one by one (the hips below a root on the ground) and have joints below.
/// \param moved whether the motion moves a joint from its rest position, [joint]
/// \return index of the joint; those above it are its ancestors, in order
std::size_t rootMotionJoint(const RestSkeleton& skeleton, const std::vector<bool>& moved);

/// The skeleton from the joint `root` of rootMotionJoint() on.
RestSkeleton skeletonFrom(const RestSkeleton& skeleton, std::size_t root);

/// Says in a notice where joints below `root` move, since a Motion holds rotations only.
void noticeUnusedMoves(const RestSkeleton& skeleton, const std::vector<bool>& moved,
                       std::size_t root, const std::string& path);

} // namespace osgSkin

#endif
