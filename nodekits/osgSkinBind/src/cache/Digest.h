// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_DIGEST_H
#define OSGSKINBIND_DIGEST_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// Of any bytes: 36 letters, digits and hyphens, another for others (SHA-1, as a UUID of version
/// 5).
std::string digestOf(const std::string& bytes);

/// Of all that elastic shapes are made of: mesh, skeleton, roles of the joints, ratios, and the
/// version of the maker.
/// \param binding of the mesh as given, without correctives
std::string digestOf(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     const WeldedMesh& mesh, const Binding& binding);

} // namespace osgSkin

#endif
