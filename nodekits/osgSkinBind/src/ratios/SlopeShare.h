// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SLOPESHARE_H
#define OSGSKINBIND_SLOPESHARE_H

#include "mesh/WeldedMesh.h"

#include <vector>

namespace osgSkin {

/// How many times steeper a field is at each vertex than it is at large.
///
/// A field that is spread by diffusion alone concentrates its slope where the skin turns inwards,
/// as in the armpit and at the crotch: from limb to trunk the way is shortest there. That skin is
/// strained most. Spread this much farther there, a field is nearly as steep everywhere.
///
/// \param mesh the skin
/// \param field one value for each welded vertex, 0 to 1
/// \return one factor for each welded vertex, at least 1: the field's slope there, mean of the
///         vertex and its neighbours, over the root mean square of its slope between 0 and 1
std::vector<double> slopeShare(const WeldedMesh& mesh, const std::vector<double>& field);

} // namespace osgSkin

#endif
