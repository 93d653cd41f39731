// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_JOINTSECTIONS_H
#define OSGSKINBINDER_CORRECTIVES_JOINTSECTIONS_H

#include "correctives/ShapedJoint.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// Areas of the sections across both bones of a bent limb, at fixed distances from the joint.
/// Points are relative to the joint's centre, one for each of its vertices.
class JointSections {
public:
    static constexpr std::size_t kCount = 8; ///< of each bone
    static constexpr double kStep = 0.4;     ///< distance between sections, in radii

    /// One value for each section, the nearest to the joint first.
    using Values = std::array<double, kCount>;
    struct Sides {
        Values parent{}, child{};
    };

    /// \param joint between limbs; must outlive this object
    explicit JointSections(const ShapedJoint& joint);

    const Sides& atRest() const { return _atRest; }

    /// The depth of the flesh on the child's inner side beside the joint, over the sum of the
    /// child's and the parent's.
    double childDepth() const { return _childDepth; }

    /// Areas of posed skin across the posed bones.
    /// \param above unit, direction of the bone above
    /// \param bone unit, from the joint to the child
    Sides areasOf(const glm::dvec3& above, const glm::dvec3& bone,
                  const std::vector<glm::dvec3>& posed) const;

    /// Interpolates the sections' values smoothly at a distance along a bone, in radii. The result
    /// falls to 0 beyond the last section.
    static double valueAt(const Values& values, double radii);

private:
    const ShapedJoint& _joint;
    std::vector<bool> _isChilds; ///< for each triangle
    Sides _atRest;
    double _childDepth = 0.5;
};

/// Finds the share by which each section of one bone is widened to keep its area, from areas at
/// growing shares.
class WidthSearch {
public:
    WidthSearch(const JointSections::Values& atRest, const JointSections::Values& areas);

    /// \param areas of the sections if all are widened by `share`
    void add(double share, const JointSections::Values& areas);

    JointSections::Values shares{};

private:
    JointSections::Values _areas, _missing{};
    std::array<bool, JointSections::kCount> _found{};
    double _last = 0.0;
};

} // namespace osgSkin

#endif
