// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_CHECKINFLUENCES_H
#define OSGSKINBIND_CHECKINFLUENCES_H

#include "joints/JointPlan.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Looks, before ratios are made, at how many influences they will be: a vertex has one of its
/// region's joint and one of each joint above it.
///
/// \param joints of planJoints()
/// \param regionOf each welded vertex, a joint
/// \param weldedOf each vertex of the mesh, a welded vertex
/// \param most of all vertices together; 0: any number
/// \throw osgSkin::Error where they are more
void checkInfluences(const std::vector<PlannedJoint>& joints,
                     const std::vector<std::uint32_t>& regionOf,
                     const std::vector<std::uint32_t>& weldedOf, std::size_t most);

} // namespace osgSkin

#endif
