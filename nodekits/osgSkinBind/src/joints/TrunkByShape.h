// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_TRUNKBYSHAPE_H
#define OSGSKINBIND_TRUNKBYSHAPE_H

#include "joints/JointPlan.h"

#include <vector>

namespace osgSkin {

/// For each joint, whether it is of the trunk: as its name says, or, in rigs that nobody knows, by
/// the skeleton's shape. Where two or more long chains begin is trunk, with all above, and so is a
/// short bone between that and a limb, a collar bone.
///
/// \param joints of planJoints()
/// \param size of the mesh
std::vector<bool> trunkByShape(const std::vector<PlannedJoint>& joints, double size);

} // namespace osgSkin

#endif
