// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_MAKESHAPES_H
#define OSGSKINBINDER_CORRECTIVES_MAKESHAPES_H

#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"
#include "garments/SkinLayers.h"

#include <osgSkinRig/JointRoles>

#include <vector>

namespace osgSkin {

/// The correctives of all joints that can be shaped, by closed forms: bends neither bulge outside
/// nor fold through themselves inside; with addTissues() where the roles say so.
/// \param roles of the skeleton's joints
/// \param layers the shells that lie on others; may be null
/// \param binding of the mesh as given, without correctives
Correctives makeFastShapes(const RestSkeleton& skeleton, const JointRoles& roles,
                           const std::vector<PlannedJoint>& joints, const WeldedMesh& mesh,
                           const SkinLayers* layers, const Binding& binding);

} // namespace osgSkin

#endif
