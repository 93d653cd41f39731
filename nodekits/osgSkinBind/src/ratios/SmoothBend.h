// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SMOOTHBEND_H
#define OSGSKINBIND_SMOOTHBEND_H

#include "limbs/BinaryField.h"
#include "mesh/SkinSmoother.h"

#include <osgSkinBind/BindOptions>

#include <vector>

namespace osgSkin {

/// A joint's bend field without boundaries from the author: its binary field
/// (BinaryField::divided()), spread over the skin about as far as the limb is thick, and exactly 0
/// and 1 beyond that.
///
/// A limb's field is as wide as leaves the middle third of its bone, and of the bone above, rigid:
/// wide on thick short bones would be rubber. On the trunk's side of a shoulder or hip there is no
/// such limit, so the two sides have a width each. Where such a limb leaves the trunk, the field is
/// spread farther where it would be steepest, as in the armpit (slopeShare()); an arm's is then
/// redistributed for the ways that arms swing (evenStretch()).
///
/// \param binary where the field starts from
/// \param smoother of the same skin
/// \param joint whose field; it has a region
/// \param radii of limbRadii()
/// \param options smoothing and cutOff count
std::vector<double> smoothBend(const BinaryField& binary, const SkinSmoother& smoother,
                               std::size_t joint, const std::vector<double>& radii,
                               const BindOptions& options);

/// Stretches [cutOff, 1 - cutOff] to [0, 1] and clamps.
void stretch(std::vector<double>& field, double cutOff);

} // namespace osgSkin

#endif
