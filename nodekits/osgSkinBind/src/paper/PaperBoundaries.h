// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PAPERBOUNDARIES_H
#define OSGSKINBIND_PAPERBOUNDARIES_H

#include "joints/JointPlan.h"
#include "limbs/BoundarySpan.h"
#include "paper/PaperRegion.h"

#include <optional>

namespace osgSkin {

/// Where the method `paper` bends, along the joint's own bone.
///
/// \param joint whose bend
/// \param radius of the limb at the joint, 0 where it is not known
BoundarySpan paperBendSpan(const PlannedJoint& joint, double radius);

/// Where the method `paper` twists, along the pole bone; unset where the twist goes with the bend.
///
/// \param joint whose twist
/// \param radius of the limb at the joint, 0 where it is not known
std::optional<BoundarySpan> paperTwistSpan(const PlannedJoint& joint, double radius);

/// Where a joint's bend region lies (paper, section 3, Fig. 3): up to a limb's radius, and at most
/// 0.3 bone lengths, to both sides of the joint, unless the author set boundaries. Each boundary
/// cuts its own bone at a right angle, so that those of a limb that is bent at rest form a wedge;
/// in the trunk, whose bones are shorter than it is thick, they halve the angle of the two bones.
///
/// \param joint whose bend
/// \param radius of the limb at the joint, 0 where it is not known
PaperRegion bendRegion(const PlannedJoint& joint, double radius);

/// Where its twist region lies: along the whole pole bone, cutting it at right angles; a twist
/// about the bone above ends as far behind the joint as the bend does. A rigid joint, and one that
/// leads to no other, twists where it bends.
///
/// \param joint whose twist
/// \param radius of the limb at the joint, 0 where it is not known
PaperRegion twistRegion(const PlannedJoint& joint, double radius);

/// True where the author set a boundary of the twist region.
bool hasOwnTwistRegion(const PlannedJoint& joint);

} // namespace osgSkin

#endif
