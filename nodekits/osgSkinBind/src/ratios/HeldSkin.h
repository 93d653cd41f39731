// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOS_HELDSKIN_H
#define OSGSKINBIND_RATIOS_HELDSKIN_H

#include "mesh/HeatGraph.h"

#include <vector>

namespace osgSkin {

/// Leaves free only skin whose field others hold at both ends.
///
/// A field that may change between skin that follows a joint and skin that does not is drawn out
/// between the two. A strap or a shoulder pad that nothing holds, or a sleeve that ends before its
/// field does, would follow the joint as a whole, or not at all, away from the body below. So of
/// the connected parts of the free skin those stay free that adjoin both kinds of kept skin, and no
/// border.
///
/// \param skin the skin itself, not a coarser copy: its triangles tell where it ends
/// \param field one value for each vertex, 0 to 1
/// \param isFree one for each vertex; taken from the parts that are not held
void keepLooseSkin(const HeatGraph& skin, const std::vector<double>& field,
                   std::vector<bool>& isFree);

} // namespace osgSkin

#endif
