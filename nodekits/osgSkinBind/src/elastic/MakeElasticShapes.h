// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_MAKEELASTICSHAPES_H
#define OSGSKINBIND_ELASTIC_MAKEELASTICSHAPES_H

#include "garments/SkinLayers.h"
#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>
#include <osgSkinBind/Progress>

#include <string>
#include <vector>

namespace osgSkin {

/// Correctives whose targets are those of an elastic solid, solved joint by joint. What cannot be
/// solved has the shapes that makeFastShapes() gives it, and a line in the notes.
/// \param layers what of the mesh lies on other skin, and is moved as that; null: nothing
/// \param binding of the mesh as given, without correctives
/// \param progress told from the calling thread; may throw to give up
/// \param notes gets a line for each joint that is not as asked for
Correctives makeElasticShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                              const WeldedMesh& mesh, const SkinLayers* layers,
                              const Binding& binding, const Progress& progress,
                              std::vector<std::string>& notes);

} // namespace osgSkin

#endif
