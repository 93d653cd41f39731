// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOFIELDS_H
#define OSGSKINBIND_RATIOFIELDS_H

#include "JointPlan.h"
#include "WeldedMesh.h"

#include <osgSkin/RestSkeleton>
#include <osgSkinBind/BindOptions>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex.
using JointFields = std::vector<std::vector<double>>;

/// Bend ratios, continuous over the skin (paper, section 3; DESIGN `smooth`): 1 at the root,
/// exactly 0 and 1 beyond a joint's bend region, never more than the parent's.
JointFields bendFields(const WeldedMesh& mesh, const RestSkeleton& skeleton,
                       const std::vector<PlannedJoint>& joints,
                       const std::vector<std::uint32_t>& regions, const BindOptions& options);

/// Twist ratios: they build up along the pole bone, within the bend field of the joint that moves
/// that bone, so they are as continuous as the bend fields.
JointFields twistFields(const WeldedMesh& mesh, const RestSkeleton& skeleton,
                        const std::vector<PlannedJoint>& joints, const JointFields& bend,
                        const BindOptions& options);

} // namespace osgSkin

#endif
