// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BENDREGION_H
#define OSGSKINBIND_BENDREGION_H

#include "JointPlan.h"
#include "WeldedMesh.h"

#include <osgSkinBind/BindOptions>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Eq. 5, flat at both ends: 0 for t <= 0, 1 for t >= 1.
double hermite(double t);

/// Unit normal of the joint's plane, which bisects the parent's bone and the joint's own.
glm::dvec3 jointPlaneNormal(const PlannedJoint& joint);

/// Where a joint's bend field starts from: regions and planes only, not yet continuous.
struct BendRegion {
    const WeldedMesh& mesh;
    const std::vector<PlannedJoint>& joints;
    const std::vector<std::uint32_t>& regions; ///< joint index of each welded vertex

    /// 1 over the subtree's regions; in the joint's own region 1 below the joint's plane; else 0.
    std::vector<double> hardField(std::size_t joint) const;

    /// The same with the paper's two boundaries (section 3) instead of one plane: eq. 5 between
    /// them, in the regions of the joint and of the one above. In units of the bone's length.
    std::vector<double> boundedField(std::size_t joint, double upper, double lower) const;

    /// R_j: median distance to the bone of the region's vertices nearest the joint's plane, capped
    /// for slender bones. 0 where the region is empty.
    double limbRadius(std::size_t joint) const;

private:
    bool isBelow(std::uint32_t region, std::size_t joint) const;
    std::uint32_t regionAbove(std::size_t joint) const;
};

} // namespace osgSkin

#endif
