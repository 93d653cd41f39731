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
/// follow it on the way to the hips and have joints below: one by one, or where names tell the
/// upper legs, also beside joints that are no part of the body (targets, a camera).
/// \param moved whether the motion moves a joint from its rest position, [joint]
/// \return index of the joint
std::size_t rootMotionJoint(const RestSkeleton& skeleton, const std::vector<bool>& moved);

/// A skeleton from a joint of its own on.
struct ReducedSkeleton {
    /// \param skeleton whole
    /// \param root of rootMotionJoint()
    ReducedSkeleton(const RestSkeleton& skeleton, std::size_t root);

    /// `root`, then all others that do not stand above it, in their order; below the root those
    /// that stood beside it.
    RestSkeleton rest;
    std::vector<std::size_t> joints; ///< of the whole skeleton, [joint of `rest`]
    std::vector<std::size_t> above;  ///< of the whole skeleton, from its root down
};

/// Says in a notice where joints other than the root move, since a Motion holds rotations only.
/// \param skeleton whole
void noticeUnusedMoves(const RestSkeleton& skeleton, const std::vector<bool>& moved,
                       const ReducedSkeleton& carried, const std::string& path);

} // namespace osgSkin

#endif
