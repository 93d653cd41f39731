// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BENDRANGE_H
#define OSGSKINBIND_BENDRANGE_H

#include "shapes/ShapedJoint.h"

#include <optional>
#include <vector>

namespace osgSkin {

/// Sets basis, axis, range and knots of a joint's functions.
/// \param mainAxis of findMainAxis(); nothing: it may bend in any direction
/// \param across where a joint that bends in any direction has its x axis: a direction of the
///        body's, so that a body that is turned or mirrored gets the same shapes; may be along the
///        twist axis
/// \param joint above, bone and twistAxis are set
/// \param mostFlexion degrees from the straight limb
/// \param knotStep degrees between knots, at most, where there is a main axis
void setBendRange(const std::optional<glm::dvec3>& mainAxis, const glm::dvec3& across,
                  ShapedJoint& joint, double mostFlexion = ShapeScope().mostFlexion,
                  double knotStep = ShapeScope().knotStep);

/// The same of a joint at the trunk, which may bend in all directions.
/// \param across as for setBendRange()
/// \param joint twistAxis is set
/// \param mostSwing degrees from the rest pose
void setBallRange(const glm::dvec3& across, ShapedJoint& joint,
                  double mostSwing = ShapeScope().mostSwing);

/// Lets a hinge turn about the limb, as knees and elbows do: sets basis and range of y.
/// \param joint of setBendRange(), with a main axis
void setTurnedHinge(ShapedJoint& joint);

/// The bends of a turned hinge that shapes are fitted to, from one end of the range to the other
/// and to both sides. They twist, too, where the hinge is not perpendicular to the bone or turns.
std::vector<BendTwist> turnedBends(const ShapedJoint& joint);

/// The bends, as coordinates (x, y) of the joint's functions, whose shapes those are fitted to: all
/// over the range and to its end, the rest pose left out.
std::vector<glm::dvec2> bendSamples(const ShapedJoint& joint);

} // namespace osgSkin

#endif
