// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOS_BENDFIELDS_H
#define OSGSKINBIND_RATIOS_BENDFIELDS_H

#include "fields/JointFields.h"
#include "limbs/BinaryField.h"

#include <osgSkinBind/BindOptions>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgSkin {

/// Bend ratios, continuous over the skin (paper, section 3): 1 at the root, exactly 0 and 1 beyond
/// a joint's bend region, never more than the parent's.
///
/// \param binary where the fields start from
/// \param radii of limbRadii()
/// \param options smoothing and cutOff count
/// \param begin is called with the joint's index before each joint's field
JointFields bendFields(const BinaryField& binary, const std::vector<double>& radii,
                       const BindOptions& options, const std::function<void(std::size_t)>& begin);

} // namespace osgSkin

#endif
