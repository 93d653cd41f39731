// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_RATIOS_PAPERFIELDS_H
#define OSGSKINBINDER_RATIOS_PAPERFIELDS_H

#include "joints/JointRegions.h"
#include "ratios/JointFields.h"
#include "regions/BinaryField.h"
#include "regions/HermiteRatio.h"

#include <optional>

namespace osgSkin {

/// t of eq. 5 (paper, section 3): the fraction |h| / |H| of the shortest segment through a point
/// between two planes that lies between the point and the upper plane.
///
/// Between parallel planes that segment is the perpendicular. In a wedge it is Philo's line, which
/// depends only on the distances to both planes and their angle.
///
/// \param toUpper distance of the point from the upper plane, in any unit; not negative
/// \param toLower distance from the lower one, in that unit; not negative, and not 0 with `toUpper`
/// \param angle between the planes, where the point is: 0 (parallel) to below pi; radians
double philoShare(double toUpper, double toLower, double angle);

/// Where a joint bends with the method `paper`, along its own bone.
///
/// \param joint the bending joint
/// \param radius of the limb at the joint, 0 if unknown
BoundarySpan paperBendSpan(const PlannedJoint& joint, double radius);

/// Where a joint twists with the method `paper`, along the pole bone; unset if the twist follows
/// the bend.
///
/// \param joint the twisting joint
/// \param radius of the limb at the joint, 0 if unknown
std::optional<BoundarySpan> paperTwistSpan(const PlannedJoint& joint, double radius);

/// Ratios as in the paper (section 3): eq. 5 between two boundary planes for each joint's bend and
/// for its twist, exactly 0 above and exactly 1 below.
///
/// A joint's planes apply in its own region, the one above and the next one of its chain. Skin of
/// other regions follows the joint fully if it belongs to the joint's subtree, else not at all. So
/// on a body the ratios jump where such a region meets the space between the planes (armpit,
/// crotch); BindOptions::Method::Smooth avoids this.
struct PaperFields {
    JointFields bend, twist;

    /// \param binary the skin, its joints and regions
    /// \param radii of limbRadii()
    PaperFields(const BinaryField& binary, const std::vector<double>& radii);
};

} // namespace osgSkin

#endif
