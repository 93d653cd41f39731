// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MAKEMUSCLES_H
#define OSGSKINBIND_MAKEMUSCLES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// The correctives of the muscles that options ask for: for each muscle one mode that follows its
/// hinge's bend and one that follows an input of its name. None where there are no muscles.
/// \param binding of the mesh as given; its correctives do not count
/// \param notes gets a line for each muscle that cannot be made
/// \throw osgSkin::Error as findMuscles() does
Correctives makeMuscles(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding, const BindOptions& options,
                        std::vector<std::string>& notes);

} // namespace osgSkin

#endif
