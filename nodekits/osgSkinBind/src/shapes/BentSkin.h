// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BENTSKIN_H
#define OSGSKINBIND_BENTSKIN_H

#include "shapes/FastTargets.h"
#include "shapes/ShapedJoint.h"

#include <array>
#include <vector>

namespace osgSkin {

/// Areas of the sections across both bones of a bent limb, at fixed distances from the joint.
/// All points relative to the joint's centre, one for each of the joint's vertices.
class JointSections {
public:
    static constexpr std::size_t kCount = 8; ///< of each bone
    static constexpr double kStep = 0.4;     ///< distance between sections, in radii

    /// One value for each section, the nearest to the joint first.
    using Values = std::array<double, kCount>;
    struct Sides {
        Values parent{}, child{};
    };

    /// \param joint outlives this; a joint between limbs
    explicit JointSections(const ShapedJoint& joint);

    /// Areas at rest.
    const Sides& atRest() const { return _atRest; }

    /// How far the flesh of the child's inner side reaches from the bone beside the joint, over the
    /// sum of the child's and the parent's.
    double childDepth() const { return _childDepth; }

    /// Areas of posed skin across the posed bones.
    Sides areasOf(const FoldShape& fold, const std::vector<glm::dvec3>& posed) const;

    /// A value for each section, interpolated smoothly at a distance along a bone, in radii. It
    /// falls to 0 behind the last section.
    static double valueAt(const Values& values, double radii);

private:
    const ShapedJoint& _joint;
    std::vector<bool> _isChilds; ///< for each triangle
    Sides _atRest;
    double _childDepth = 0.5;
};

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
    std::vector<glm::dvec3> targets(double volumeAtRest, const JointSections* sections) const;

    /// What it counts that a vertex gets there (see JointShapes).
    std::vector<double> weights() const;

private:
    std::vector<glm::dvec3> limbTargets(const JointSections& sections) const;
    std::vector<glm::dvec3> widened(const std::vector<glm::dvec3>& points,
                                    const JointSections::Sides& shares) const;
    JointSections::Sides sharesFor(const std::vector<glm::dvec3>& shaped,
                                   const JointSections& sections) const;
    std::vector<glm::dvec3> trunkTargets(double volumeAtRest) const;

    const ShapedJoint& _joint;
    BendTwist _bend;
    FoldShape _fold;
    std::vector<glm::dvec3> _posed;
};

} // namespace osgSkin

#endif
