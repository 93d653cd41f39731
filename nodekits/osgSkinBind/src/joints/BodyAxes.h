// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BODYAXES_H
#define OSGSKINBIND_BODYAXES_H

#include "joints/JointPlan.h"

#include <optional>
#include <vector>

namespace osgSkin {

/// Where a body looks, rest space: the mean direction in which feet point, of any length; zero
/// where there are none.
glm::dvec3 facing(const std::vector<PlannedJoint>& joints);

/// Unit directions of an upright body at rest, perpendicular to each other.
struct BodyAxes {
    glm::dvec3 up{0.0}, front{0.0};
};

/// From the root to the head, and to where feet point; nothing without a head or feet.
std::optional<BodyAxes> bodyAxes(const std::vector<PlannedJoint>& joints);

/// Whether a joint or one below it is such a part of the body.
bool carries(const std::vector<PlannedJoint>& joints, std::size_t joint, JointPart part);

} // namespace osgSkin

#endif
