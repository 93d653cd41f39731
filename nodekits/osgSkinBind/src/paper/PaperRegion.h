// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PAPERREGION_H
#define OSGSKINBIND_PAPERREGION_H

#include <glm/vec3.hpp>

namespace osgSkin {

/// A boundary of a bend or twist region (paper, section 3, Fig. 3).
struct BoundaryPlane {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0}; ///< unit, towards the child
};

/// A bend or twist region as printed: the skin between an upper boundary, towards the parent, and a
/// lower one, towards the child.
struct PaperRegion {
    BoundaryPlane upper, lower;

    /// The fraction of the joint's angle that skin at `p` takes: exactly 0 above the upper
    /// boundary, exactly 1 below the lower one, eq. 5 in between.
    ///
    /// Inclined planes cross on the inner side of the bend. Beyond, a point is above the one and
    /// below the other: there it goes from what the one says to what the other says, so that
    /// it is continuous all around the line where they cross.
    double ratio(const glm::dvec3& p) const;
};

} // namespace osgSkin

#endif
