// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_JOINTS_BODYAXES_H
#define OSGSKINBINDER_JOINTS_BODYAXES_H

#include "joints/JointRegions.h"

#include <optional>
#include <vector>

namespace osgSkin {

/// Marks the joints of the trunk: those with several of head, hands and feet below them, and collar
/// bones, which are the first bones of an arm that are shorter than the next. Their skin is not a
/// limb's even on a slender body. A skeleton without such names has none.
///
/// \pre the joints' parts, extremities and axes are set
void markTrunk(std::vector<PlannedJoint>& joints);

/// For each joint, whether it belongs to the trunk: by its name or, in unknown rigs, by the
/// skeleton's shape. The trunk consists of the joints at which two or more long chains begin, all
/// joints above them, and collar bones: short bones between these and a limb.
///
/// \param joints of planJoints()
/// \param size of the mesh
std::vector<bool> trunkByShape(const std::vector<PlannedJoint>& joints, double size);

/// The direction that a body faces, rest space: the mean direction of the feet, of any length; zero
/// without feet.
glm::dvec3 facing(const std::vector<PlannedJoint>& joints);

/// Unit directions of an upright body at rest, perpendicular to each other.
struct BodyAxes {
    glm::dvec3 up{0.0}, front{0.0};
};

/// From the root to the head, and in the direction of the feet; unset without a head or feet.
std::optional<BodyAxes> bodyAxes(const std::vector<PlannedJoint>& joints);

/// True if the joint, or one below it, is this part of the body.
bool carries(const std::vector<PlannedJoint>& joints, std::size_t joint, JointPart part);

} // namespace osgSkin

#endif
