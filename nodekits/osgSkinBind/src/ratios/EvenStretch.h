// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOS_EVENSTRETCH_H
#define OSGSKINBIND_RATIOS_EVENSTRETCH_H

#include "mesh/HeatGraph.h"

#include <vector>

namespace osgSkin {

/// Redistributes a joint's bend field so that the joint's turns stretch no skin much more than
/// other skin.
///
/// Where a vertex's ratio exceeds its neighbour's by d, a turn by the vector w about the centre c
/// makes their edge e to e + d w x (x - c), seen from the neighbour: longer on the one side of a
/// limb, shorter on the other, and the more the farther it is from the axis. The sum over edges and
/// turns of the fourth power of the stretch, and of a smaller one of the whole change, is convex in
/// the field; Newton's method finds its least.
///
/// \param skin the skin, or a coarser copy of it
/// \param field one value for each vertex, 0 to 1; what is not free is kept
/// \param isFree which vertices may change
/// \param centre of the joint
/// \param turns axis times angle, radians, at least one
void evenStretch(const HeatGraph& skin, std::vector<double>& field, const std::vector<bool>& isFree,
                 const glm::dvec3& centre, const std::vector<glm::dvec3>& turns);

} // namespace osgSkin

#endif
