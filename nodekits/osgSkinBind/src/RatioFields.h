// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOFIELDS_H
#define OSGSKINBIND_RATIOFIELDS_H

#include "HardField.h"

#include <osgSkinBind/BindOptions>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex.
using JointFields = std::vector<std::vector<double>>;

/// Bend ratios, continuous over the skin (paper, section 3): 1 at the root, exactly 0 and 1 beyond
/// a joint's bend region, never more than the parent's. \param radii of limbRadii() \param begin is
/// called before each joint's field
JointFields bendFields(const HardField& hard, const std::vector<double>& radii,
                       const BindOptions& options, const std::function<void(std::size_t)>& begin);

/// Twist ratios: they build up along the pole bone, within the bend field of the joint that moves
/// that bone, so they are as continuous as the bend fields. Never more than the parent's.
JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend);

} // namespace osgSkin

#endif
