// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BOUNDARYSPAN_H
#define OSGSKINBIND_BOUNDARYSPAN_H

#include "joints/JointPlan.h"

#include <optional>

namespace osgSkin {

/// The upper and lower boundary of a bend or twist region (paper, Fig. 3): along a bone from the
/// joint's centre, in units of that bone's length, negative towards the parent.
struct BoundarySpan {
    double upper, lower;
};

/// Where the twist fields of the method `smooth` build up; none where the twist goes with the bend.
std::optional<BoundarySpan> twistSpan(const PlannedJoint& joint, double radius);

/// The same for the method `paper`.
std::optional<BoundarySpan> paperTwistSpan(const PlannedJoint& joint, double radius);

/// Where the method `paper` bends; the method `smooth` has no boundaries to name.
BoundarySpan paperBendSpan(const PlannedJoint& joint, double radius);

} // namespace osgSkin

#endif
