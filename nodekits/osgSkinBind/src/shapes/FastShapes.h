// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FASTSHAPES_H
#define OSGSKINBIND_FASTSHAPES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

namespace osgSkin {

/// Correctives whose targets are closed forms: limbs that bend without a balloon outside and
/// without going through themselves inside.
/// \param binding of the mesh as given, without correctives
Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding);

} // namespace osgSkin

#endif
