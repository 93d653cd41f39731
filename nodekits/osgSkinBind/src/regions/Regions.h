// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_H
#define OSGSKINBIND_REGIONS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

#include <osgSkinBind/Progress>

#include <vector>

namespace osgSkin {

/// Delaunay step, flooding step, and what real meshes need beside them: shells that no Delaunay
/// edge reaches and islands.
///
/// \param mesh the skin
/// \param joints of planJoints()
/// \param progress is told as each of these begins; may be empty
/// \return a region for every vertex
Regions findRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                    const Progress& progress);

} // namespace osgSkin

#endif
