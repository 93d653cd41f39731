// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_ADDSHAPES_H
#define OSGSKINBINDER_CORRECTIVES_ADDSHAPES_H

#include "garments/SkinLayers.h"
#include "joints/JointRegions.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// Adds what goes beyond the paper: correctives for shapes and muscles, gradients for normals.
/// \param layers the shells that lie on others; may be null
/// \param options with shapes and normals decided()
/// \param binding of the mesh that `mesh` was welded from
/// \param progress of this part of the work
/// \param notes gets a line for each request that could not be met
void addShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
               const WeldedMesh& mesh, const SkinLayers* layers, const BindOptions& options,
               const Progress& progress, Binding& binding, std::vector<std::string>& notes);

/// Adds normals' correctives to a binding that has correctives and gradients: each joint is bent
/// over its whole range, and the remaining error of the corrected skin's normals is fitted by the
/// functions that the joint already has.
/// \param binding of the mesh that `mesh` was welded from; changed
void addNormalCorrectives(const WeldedMesh& mesh, Binding& binding);

} // namespace osgSkin

#endif
