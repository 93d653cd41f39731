// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_RATIOS_EVENSTRETCH_H
#define OSGSKINBINDER_RATIOS_EVENSTRETCH_H

#include "mesh/HeatGraph.h"

#include <vector>

namespace osgSkin {

/// Fixes patches of free skin whose field is not fixed at both ends.
///
/// minimizeStretch() spreads a field evenly between fixed skin that follows a joint and fixed skin
/// that does not. A strap or shoulder pad without fixed neighbours, or a sleeve that ends before
/// its field does, would follow the joint fully or not at all, away from the body below. So a
/// connected patch of free skin stays free only if it adjoins both kinds of fixed skin and no
/// border.
///
/// \param skin the skin itself, not a coarser copy, as the triangles' borders are needed
/// \param field one value for each vertex, 0 to 1
/// \param isFree one for each vertex; cleared for the patches that become fixed
void pinUnanchoredPatches(const HeatGraph& skin, const std::vector<double>& field,
                          std::vector<bool>& isFree);

/// Redistributes a joint's bend field so that the joint's rotations stretch the skin evenly.
///
/// If a vertex's ratio exceeds its neighbour's by d, a rotation by the vector w about the centre c
/// changes their edge e to e + d w x (x - c), relative to the neighbour: longer on one side of a
/// limb, shorter on the other, and more so far from the axis. The energy is the sum over edges and
/// rotations of the fourth power of the stretch, plus a smaller term for the whole change. It is
/// convex in the field, and minimised by Newton's method.
///
/// \param skin the skin, or a coarser copy of it
/// \param field one value for each vertex, 0 to 1; fixed vertices keep theirs
/// \param isFree for each vertex, whether it may change
/// \param centre of the joint
/// \param turns axis times angle, radians, at least one
void minimizeStretch(const HeatGraph& skin, std::vector<double>& field,
                     const std::vector<bool>& isFree, const glm::dvec3& centre,
                     const std::vector<glm::dvec3>& turns);

} // namespace osgSkin

#endif
