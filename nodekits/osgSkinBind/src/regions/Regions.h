// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_H
#define OSGSKINBIND_REGIONS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

#include <osgSkinBind/BindProgress>

#include <vector>

namespace osgSkin {

/// Delaunay step, flooding step, and what real meshes need beside them: shells that no Delaunay
/// edge reaches and islands. \param tell is called as each of these begins, with its name and the
/// share of the time that is over
Regions findRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                    const BindProgress& tell);

} // namespace osgSkin

#endif
