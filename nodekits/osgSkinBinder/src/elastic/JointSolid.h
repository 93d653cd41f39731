// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_JOINTSOLID_H
#define OSGSKINBINDER_ELASTIC_JOINTSOLID_H

#include "elastic/Minimise.h"
#include "elastic/SolveElastic.h"
#include "elastic/solid/RestSkin.h"
#include "mesh/Parallel.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgSkin::elastic {

/// The order in which a joint's samples are solved: each starts from the nearest one with a smaller
/// angle, so that bends grow in small steps and no step is solved twice.
struct SampleTree {
    static constexpr std::size_t kRest = static_cast<std::size_t>(-1);

    /// \param rotations unit
    explicit SampleTree(const std::vector<Eigen::Quaterniond>& rotations);

    /// The samples that start from a sample, or from the rest pose (kRest).
    const std::vector<std::size_t>& startingFrom(std::size_t sample) const;

private:
    std::vector<std::vector<std::size_t>> _following; ///< the rest pose is last
};

/// Solves one joint, see solveElasticJoint().
ElasticShapes solveJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                         SharedProgress& progress);

} // namespace osgSkin::elastic

#endif
