// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FASTSHAPES_H
#define OSGSKINBIND_FASTSHAPES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "shapes/ShapeFit.h"
#include "shapes/ShapedJoint.h"

#include <osgSkin/Binding>

namespace osgSkin {

/// The shapes of one joint by closed forms: its limbs bend without a balloon outside and without
/// going through themselves inside.
FittedShapes fastShapesOf(const ShapedJoint& joint);

/// Correctives of all joints between two limbs, see fastShapesOf().
/// \param binding of the mesh as given, without correctives
Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding);

} // namespace osgSkin

#endif
