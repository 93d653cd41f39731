// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BENTSKIN_H
#define OSGSKINBIND_BENTSKIN_H

#include "shapes/FastTargets.h"
#include "shapes/LimbSections.h"
#include "shapes/ShapedJoint.h"

#include <vector>

namespace osgSkin {

/// A joint's skin in one bend, and where closed forms want it. All points from the joint's centre,
/// for each of the joint's vertices.
class BentSkin {
public:
    /// \param childShare of the angle between both bones that the child's flesh takes, 1/2 for half
    BentSkin(const ShapedJoint& joint, const BendTwist& bend, double childShare = 0.5);

    /// Six times what lies between the skin and the joint's centre.
    static double volumeOf(const ShapedJoint& joint, const std::vector<glm::dvec3>& points);

    /// Where the vertices are to be.
    /// \param sections of the joint between limbs; null at the trunk
    std::vector<glm::dvec3> targets(double volumeAtRest, const LimbSections* sections) const;

    /// What it counts that a vertex gets there (see JointShapes).
    std::vector<double> weights() const;

private:
    std::vector<glm::dvec3> limbTargets(const LimbSections& sections) const;
    std::vector<glm::dvec3> widened(const std::vector<glm::dvec3>& points,
                                    const LimbSections::Sides& shares) const;
    LimbSections::Sides sharesFor(const std::vector<glm::dvec3>& shaped,
                                  const LimbSections& sections) const;
    std::vector<glm::dvec3> trunkTargets(double volumeAtRest) const;

    const ShapedJoint& _joint;
    BendTwist _bend;
    FoldShape _fold;
    std::vector<glm::dvec3> _posed;
};

} // namespace osgSkin

#endif
