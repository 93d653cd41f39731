// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ADDSHAPES_H
#define OSGSKINBIND_ADDSHAPES_H

#include "joints/JointPlan.h"
#include "layers/SkinLayers.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// The options with what is unset decided.
/// \param ownRatios whether ratios are found by us, instead of an artist's weights
BindOptions decided(BindOptions options, bool ownRatios);

/// Adds what goes beyond the paper: correctives for shapes and muscles, gradients for normals.
/// \param layers what of the mesh lies on other skin; null: nothing
/// \param options with shapes and normals decided()
/// \param binding of the mesh as given, whose vertices `mesh` has welded
/// \param progress of this part of the work
/// \param notes gets a line for what is not as asked for
void addShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
               const WeldedMesh& mesh, const SkinLayers* layers, const BindOptions& options,
               const Progress& progress, Binding& binding, std::vector<std::string>& notes);

/// The fraction of the time that binding takes without shapes, about.
/// \param options with shapes decided()
double shareWithoutShapes(const BindOptions& options);

} // namespace osgSkin

#endif
