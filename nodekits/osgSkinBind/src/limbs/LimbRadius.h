// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_LIMBRADIUS_H
#define OSGSKINBIND_LIMBRADIUS_H

#include "limbs/BinaryField.h"

#include <vector>

namespace osgSkin {

/// R_j for each joint: the limb's radius where it bends, the median distance to the bone's line of
/// the skin that the joint's BinaryField::divided() parts. 0 for joints without a region or with an
/// empty one.
std::vector<double> limbRadii(const BinaryField& binary);

/// True where the bone is long for its radius and not of the trunk: upper arm, forearm, thigh,
/// shin.
bool isLimb(const PlannedJoint& joint, double radius);

} // namespace osgSkin

#endif
