// SPDX-License-Identifier: MIT
#ifndef OSGSKINBIND_BIND_CHECKOPTIONS_H
#define OSGSKINBIND_BIND_CHECKOPTIONS_H

#include "joints/JointPlan.h"

#include <osgSkinBind/BindOptions>
#include <osgSkinBind/Export>
#include <osgSkinRig/RestSkeleton>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// \throw osgSkin::Error if an option names a joint that does not exist, or a value is out of range
OSGSKINBIND_EXPORT void checkOptions(const RestSkeleton& skeleton, const BindOptions& options);

/// The options with defaults for the unset ones.
/// \param ownRatios true if bind() computes the ratios, false for an artist's weights
OSGSKINBIND_EXPORT BindOptions decided(BindOptions options, bool ownRatios);

/// Limits the total number of influences before ratios are computed: a vertex has one for its
/// region's joint and one for each joint above it.
///
/// \param joints of planJoints()
/// \param regionOf for each welded vertex, its region's joint
/// \param weldedOf for each vertex of the mesh, the welded vertex
/// \param most the largest number; 0: no limit
/// \throw osgSkin::Error if there are more
OSGSKINBIND_EXPORT void checkInfluences(const std::vector<PlannedJoint>& joints,
                                        const std::vector<std::uint32_t>& regionOf,
                                        const std::vector<std::uint32_t>& weldedOf,
                                        std::size_t most);

} // namespace osgSkin

#endif
