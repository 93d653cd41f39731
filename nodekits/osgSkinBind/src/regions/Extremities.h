// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_EXTREMITIES_H
#define OSGSKINBIND_REGIONS_EXTREMITIES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <vector>

namespace osgSkin {

/// Sets `beyond` of heads, hands and feet: all skin beyond the narrowest section of the limb
/// through the joint.
///
/// A section is the loop in which a plane cuts the skin around the limb. The skin is parted along
/// it, and all that hangs together beyond it belongs to the extremity, whichever way it hangs: a
/// chin below the joint, or the mouth's inside. Nothing is set where no plane cuts a loop that
/// parts the skin, as on open or coarse meshes.
///
/// \param mesh the skin
/// \param joints of planJoints()
void findExtremities(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
