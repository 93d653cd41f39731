// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTS_BONESAMPLES_H
#define OSGSKINBIND_JOINTS_BONESAMPLES_H

#include "joints/JointPlan.h"

#include <string>
#include <vector>

namespace osgSkin {

/// Sets the points that stand for each joint in the Delaunay step, and which joints have regions.
///
/// Points lie along the bones to the joint's children and to its tip, after Teichmann and Teller
/// (1998), whom the paper follows; a bone without a length leaves its points to the region above.
/// A last joint without a tip goes on, in the direction of the bone above, to where it leaves the
/// skin. Only points inside the skin count. With the method `paper` a joint's only point is its
/// centre.
///
/// A joint owns nothing where its bone runs outside the skin (a root on the floor), or where it is
/// a control: a last joint without a tip or a known name, to which no bone leads inside the skin
/// (an IK target). A joint in the middle of a chain that lies outside claims the skin around it.
/// Where all are outside, all keep their regions.
///
/// \param joints with axes, and `holdsRegion` where nothing but the skin speaks against it
void setSamples(const RestSkeleton& skeleton, const WeldedMesh& mesh, const JointRoles& roles,
                BindOptions::Method method, std::vector<PlannedJoint>& joints,
                std::vector<std::string>& notes);

} // namespace osgSkin

#endif
