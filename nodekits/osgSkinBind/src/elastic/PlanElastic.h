// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_PLANELASTIC_H
#define OSGSKINBIND_ELASTIC_PLANELASTIC_H

#include "elastic/joint/ElasticJoint.h"
#include "shapes/ShapedJoint.h"

#include <vector>

namespace osgSkin {

/// A joint to solve, and what its shapes are fitted to.
struct ElasticPlan {
    ShapedJoint shaped;
    ElasticJoint joint;

    /// A rotation of the joint without twist as coordinates of its functions.
    glm::dvec2 coordinatesOf(const glm::dquat& rotation) const;
};

/// The joints whose limbs have the shape for it: between two limbs, where it is known which way
/// they bend, and at the trunk.
/// \param binding of the mesh as given, whose vertices `mesh` has welded
std::vector<ElasticPlan> planElastic(const RestSkeleton& skeleton,
                                     const std::vector<PlannedJoint>& joints,
                                     const WeldedMesh& mesh, const Binding& binding);

} // namespace osgSkin

#endif
