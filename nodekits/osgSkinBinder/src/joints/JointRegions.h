// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_JOINTS_JOINTREGIONS_H
#define OSGSKINBINDER_JOINTS_JOINTREGIONS_H

#include "joints/JointPlan.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Unit normal of the joint's plane, towards the child. The plane bisects the angle between the
/// bone above and the joint's own; along the trunk, whose bones zigzag, they are weighted by
/// length.
glm::dvec3 planeNormal(const PlannedJoint& joint);

/// Distance of a point, rest space, to the joint's bone, which may have no length.
double distanceToBone(const PlannedJoint& joint, const glm::dvec3& point);

/// For each joint, whether it is `joint` or below it in the tree.
std::vector<bool> subtreeOf(const std::vector<PlannedJoint>& joints, std::size_t joint);

/// The nearest joint above that has a region, or else the root.
std::size_t regionAbove(const std::vector<PlannedJoint>& joints, std::size_t joint);

/// Sets the joints' points for the Delaunay step, and `region`. Part of planJoints().
///
/// Points lie along the bones to the joint's children and to its tip, after Teichmann and Teller
/// (1998), whom the paper follows; those of a bone without a length go to the region above. A last
/// joint without a tip has points in the direction of the bone above, up to where that leaves the
/// skin. Points outside the skin are dropped. With the method `paper` a joint's only point is its
/// centre.
///
/// A joint loses its region if its bone runs outside the skin (a root on the floor), or if it is a
/// control: a last joint without a tip or a known name, to which no bone leads inside the skin (an
/// IK target). A joint outside the skin in the middle of a chain claims the skin around it. If all
/// joints are outside, all keep their regions.
///
/// \param joints with axes, and with `region` as far as it does not depend on the skin
void setSamples(const RestSkeleton& skeleton, const WeldedMesh& mesh, const JointRoles& roles,
                BindOptions::Method method, std::vector<PlannedJoint>& joints,
                std::vector<std::string>& notes);

/// Axes, poles, roles and regions of the joints, in the skeleton's order.
///
/// \param skeleton valid
/// \param mesh decides which joints are inside the skin
/// \param options checked
/// \param notes gets a line for each unusual finding, such as joints outside the skin
/// \throw osgSkin::Error if an option names a joint that does not exist
std::vector<PlannedJoint> planJoints(const RestSkeleton& skeleton, const WeldedMesh& mesh,
                                     const BindOptions& options, std::vector<std::string>& notes);

} // namespace osgSkin

#endif
