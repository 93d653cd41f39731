// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_TRUNKJOINTS_H
#define OSGSKINBIND_TRUNKJOINTS_H

#include "joints/JointPlan.h"

#include <vector>

namespace osgSkin {

/// Marks the joints that carry the trunk: those below which stand several of head, hands and feet,
/// and the collar bones, the first bones of an arm where they are shorter than the next. Their skin
/// is no limb's, however slender the body is. A skeleton without such names has none.
///
/// \pre the joints' parts, extremities and axes are set
void markTrunk(std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
