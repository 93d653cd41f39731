// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_BODYBRANCHES_H
#define OSGSKINBIND_FIT_BODYBRANCHES_H

#include "fit/surface/CurveSkeleton.h"

#include <glm/mat3x3.hpp>

#include <array>
#include <vector>

namespace osgSkin {

/// Which of a body's medial curves are trunk, legs and arms.
///
/// All paths are points of the standing body: y up, the floor at 0, the top of the head at 1.
struct BodyBranches {
    using Path = std::vector<glm::dvec3>;

    Path trunk;               ///< from the top of the head down to where the legs part
    std::array<Path, 2> legs; ///< from there to the end of each foot; [0] is the left one
    std::array<Path, 2> arms; ///< from the trunk to the end of each hand; [0] is the left one

    /// Tells the curves apart by height and length; left and right are not known yet, but the
    /// arm and the leg of one index are on one side.
    ///
    /// \param skeleton of the standing body
    /// \param legsGiven landmarks stand in for legs that are not found: their paths are left empty
    /// \param armsGiven the same for arms
    /// \throw Error where there are not a head above, two legs below and two arms between
    static BodyBranches find(const CurveSkeleton& skeleton, bool legsGiven, bool armsGiven);

    /// Applies p -> rotation * (p - origin).
    void transform(const glm::dmat3& rotation, const glm::dvec3& origin);

    /// Makes the limbs at x > 0 the left ones, once x points to the body's left.
    void sortSides();
};

/// Length of a path.
double pathLength(const BodyBranches::Path& path);

/// The point at a fraction (0 to 1) of the length of a path that is not empty.
glm::dvec3 pathPoint(const BodyBranches::Path& path, double fraction);

} // namespace osgSkin

#endif
