// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ROOTJOINT_H
#define OSGSKINIMPORT_ROOTJOINT_H 1

#include <osgSkinRig/RestSkeleton>

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Whether a joint's position differs from its rest position by more than rounding.
bool isMoved(const glm::dvec3& position, const glm::dvec3& atRest);

/// The joint that carries the figure's root motion: the last moving joint with children on the path
/// from the root towards the hips. The path follows single children, and at a branch the child
/// above both upper legs, if their names are recognised; its siblings are not part of the body
/// (targets, a camera).
/// \param skeleton whole
/// \param moved whether the motion moves a joint from its rest position, [joint]
/// \return index of the joint; the root if no joint on the path moves
std::size_t rootMotionJoint(const RestSkeleton& skeleton, const std::vector<bool>& moved);

/// A skeleton re-rooted at one of its joints.
struct ReducedSkeleton {
    /// \param skeleton whole
    /// \param root the joint found by rootMotionJoint()
    ReducedSkeleton(const RestSkeleton& skeleton, std::size_t root);

    /// `root`, then all other joints that are not its ancestors, in their order. Joints from other
    /// branches become children of the root.
    RestSkeleton rest;
    std::vector<std::size_t> joints; ///< in the whole skeleton, [joint of `rest`]
    std::vector<std::size_t> above;  ///< ancestors in the whole skeleton, from its root down
};

/// Reports joints other than the root that move, because a Motion contains rotations only.
/// \param skeleton whole
/// \param moved whether the motion moves a joint from its rest position, [joint]
/// \param carried the re-rooted skeleton
/// \param path of the file
void warnUnusedMoves(const RestSkeleton& skeleton, const std::vector<bool>& moved,
                     const ReducedSkeleton& carried, const std::string& path);

} // namespace osgSkin

#endif
