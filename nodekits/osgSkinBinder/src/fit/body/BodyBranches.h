// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_BODY_BODYBRANCHES_H
#define OSGSKINBINDER_FIT_BODY_BODYBRANCHES_H

#include "fit/body/CurveSkeleton.h"
#include "fit/body/FitSurface.h"

#include <glm/mat3x3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace osgSkin {

/// The medial curves of a body's trunk, legs and arms, in the space of the standing body: y up, the
/// floor at 0, the top of the head at 1.
struct BodyBranches {
    using Path = std::vector<glm::dvec3>;

    Path trunk;               ///< from the top of the head down to where the legs fork
    std::array<Path, 2> legs; ///< from there to the end of each foot; [0] is the left one
    std::array<Path, 2> arms; ///< from the trunk to the end of each hand; [0] is the left one

    /// Identifies the curves by height and length. Left and right are not known yet, but the arm
    /// and the leg of one index are on one side.
    ///
    /// \param legsGiven landmarks replace legs that are not found: their paths stay empty
    /// \param armsGiven the same for arms
    /// \throw Error if there are not a head above, two legs below and two arms between
    static BodyBranches find(const CurveSkeleton& skeleton, bool legsGiven, bool armsGiven);

    /// Applies p -> rotation * (p - origin).
    void transform(const glm::dmat3& rotation, const glm::dvec3& origin);

    /// Makes the limbs at x > 0 the left ones.
    /// \pre x points to the body's left
    void sortSides();
};

double pathLength(const BodyBranches::Path& path);

/// The point at a fraction (0 to 1) of the length of a path that is not empty.
glm::dvec3 pathPoint(const BodyBranches::Path& path, double fraction);

/// Sections across a limb's medial curve, from the trunk outwards, without those that cut the
/// trunk.
std::vector<Section> limbSections(const FitSurface& surface, const BodyBranches::Path& path);

/// Where two limbs, or a limb and the trunk, fork.
struct Fork {
    glm::dvec3 point; ///< the skin's saddle between them
    Section a, b;     ///< of each limb beside it
};

/// Finds the fork of two limbs by moving a plane from between them into the fork, until the plane's
/// sections around both medial curves are one.
///
/// \param surface the body's surface
/// \param a the medial curve of one limb
/// \param b that of the other
/// \param outside a point between the limbs, away from the fork
/// \param direction the plane's normal, unit, out of the fork
/// \param reach how far to move, in heights
/// \return not set if the sections do not join within reach
std::optional<Fork> findFork(const FitSurface& surface, const BodyBranches::Path& a,
                             const BodyBranches::Path& b, const glm::dvec3& outside,
                             const glm::dvec3& direction, double reach);

} // namespace osgSkin

#endif
