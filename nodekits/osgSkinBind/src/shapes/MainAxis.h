// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MAINAXIS_H
#define OSGSKINBIND_MAINAXIS_H

#include "joints/JointPlan.h"

#include <optional>

namespace osgSkin {

/// The axis about which a joint between two limbs mostly bends: a turn about it by a positive angle
/// flexes the joint. Unit, perpendicular to the joint's twist axis; nothing where neither the rest
/// pose nor the joints' names tell.
///
/// A joint that is bent at rest bends on. One that is straight bends as an elbow or a knee does
/// where a hand or a foot follows: towards where the feet point, or away from there.
std::optional<glm::dvec3> findMainAxis(const RestSkeleton& skeleton,
                                       const std::vector<PlannedJoint>& joints, std::size_t joint);

/// The axis in space that a joint's bone turns about, which need not be perpendicular to the bone.
/// Some rigs bend knees about the axis across the body, others across the shin: a knee's lies
/// halfway between. That of another joint is the main axis.
/// \param mainAxis of findMainAxis()
glm::dvec3 findHinge(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     std::size_t joint, const glm::dvec3& mainAxis);

} // namespace osgSkin

#endif
