// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_SEEDREGIONS_H
#define OSGSKINBIND_REGIONS_SEEDREGIONS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

namespace osgSkin {

/// The Delaunay step alone: seeds labelled, all other vertices kNone.
Regions seedRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
