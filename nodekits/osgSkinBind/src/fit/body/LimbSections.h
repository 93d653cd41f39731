// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_LIMBSECTIONS_H
#define OSGSKINBIND_FIT_LIMBSECTIONS_H

#include "fit/body/BodyBranches.h"
#include "fit/body/BodySurface.h"

#include <optional>
#include <vector>

namespace osgSkin {

/// Sections across a limb's medial curve, from the trunk outwards; those that cut the trunk too
/// are left out.
std::vector<Section> limbSections(const BodySurface& surface, const BodyBranches::Path& path);

/// Where two limbs (or a limb and the trunk) part.
struct Fork {
    glm::dvec3 point; ///< the skin's saddle between them
    Section a, b;     ///< of each limb, just outside
};

/// Finds the fork of two limbs.
///
/// Planes across `direction`, which points out of the fork, are moved from `outside` against it
/// until the sections around `a` and around `b` are one.
///
/// \param surface the body's
/// \param a medial curve of one limb
/// \param b medial curve of the other
/// \param outside a point between the limbs, away from the fork
/// \param direction unit, out of the fork
/// \param reach how far to move, in heights
/// \return unset where they do not meet within reach
std::optional<Fork> findFork(const BodySurface& surface, const BodyBranches::Path& a,
                             const BodyBranches::Path& b, const glm::dvec3& outside,
                             const glm::dvec3& direction, double reach);

} // namespace osgSkin

#endif
