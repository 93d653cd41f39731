// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FINDATTACHED_H
#define OSGSKINBIND_FINDATTACHED_H

#include "joints/JointPlan.h"
#include "layers/Attached.h"
#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

#include <vector>

namespace osgSkin {

/// The vertices of shells that lie on others, by orderedShells(): those that are near such a one,
/// above it rather than beside it, and turned as it is. What is near but turned the other way, as
/// the inside of a cloth is, goes with the nearest of its shell that lies on one.
///
/// Where a joint's seeds are on a shell rather than on those below it, it does not lie on them; an
/// eye of its own joint lies on none at all.
///
/// \param regions as the shells have them by themselves
/// \param radii of limbRadii(): how near is near
/// \return each after those that it may lie on
std::vector<Attached> findAttached(const WeldedMesh& mesh, const Regions& regions,
                                   const std::vector<PlannedJoint>& joints,
                                   const std::vector<double>& radii);

} // namespace osgSkin

#endif
