// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ADDSHAPES_H
#define OSGSKINBIND_ADDSHAPES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// Adds the correctives that the options ask for.
/// \param binding of the mesh as given, whose vertices `mesh` has welded
/// \param progress of this part of the work
/// \param notes gets a line for what is not as asked for
void addShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
               const WeldedMesh& mesh, const BindOptions& options, const Progress& progress,
               Binding& binding, std::vector<std::string>& notes);

/// The fraction of the time that binding takes without shapes, about.
double shareWithoutShapes(const BindOptions& options);

} // namespace osgSkin

#endif
