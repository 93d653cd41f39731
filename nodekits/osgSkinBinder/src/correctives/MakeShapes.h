// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_MAKESHAPES_H
#define OSGSKINBINDER_CORRECTIVES_MAKESHAPES_H

#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"
#include "garments/SkinLayers.h"

#include <osgSkinBind/Progress>
#include <osgSkinRig/JointRoles>

#include <string>
#include <vector>

namespace osgSkin {

/// The shapes of one joint by closed forms: bends neither bulge outside nor fold through themselves
/// inside.
FittedShapes fastShapesOf(const ShapedJoint& joint);

/// The correctives of all joints that can be shaped, with addTissues() where the roles say so.
/// \param roles of the skeleton's joints
/// \param layers the shells that lie on others; may be null
/// \param binding of the mesh as given, without correctives
Correctives makeFastShapes(const RestSkeleton& skeleton, const JointRoles& roles,
                           const std::vector<PlannedJoint>& joints, const WeldedMesh& mesh,
                           const SkinLayers* layers, const Binding& binding);

/// Correctives whose targets are those of an elastic solid, solved joint by joint. Joints that
/// cannot be solved have those of fastShapesOf() without tissues, and a line in the notes.
/// \param layers tells which vertices lie on other skin: they move with that skin; may be null
/// \param binding of the mesh as given, without correctives
/// \param progress called from the calling thread; may throw to give up
/// \param notes gets a line for each joint whose shapes are not elastic or partly guessed
Correctives makeElasticShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                              const WeldedMesh& mesh, const SkinLayers* layers,
                              const Binding& binding, const Progress& progress,
                              std::vector<std::string>& notes);

} // namespace osgSkin

#endif
