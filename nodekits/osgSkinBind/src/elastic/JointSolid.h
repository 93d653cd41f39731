// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_JOINTSOLID_H
#define OSGSKINBIND_ELASTIC_JOINTSOLID_H

#include "elastic/Parallel.h"
#include "elastic/SolveElastic.h"
#include "elastic/solid/RestSkin.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgSkin::elastic {

/// An energy for minimise().
struct Energy {
    /// Value at the points, infinite where it is not defined; writes its gradient.
    std::function<double(const Points& at, Points& gradient)> value;
    /// An approximate inverse Hessian times a gradient: a displacement.
    std::function<Points(const Points& gradient)> precondition;
    /// Called every few steps before the value is computed again; may change the energy.
    std::function<void(const Points& at)> renew;
};

struct MinimiseLimits {
    int mostSteps = 240;
    int renewEvery = 8;      ///< steps
    double smallStep = 1e-3; ///< largest displacement of a point that counts as rest
};

struct MinimiseResult {
    bool converged = false;
    int steps = 0;
};

/// L-BFGS (Nocedal & Wright 2006, algorithm 7.4) with the preconditioner as initial inverse
/// Hessian, and backtracking.
/// \pre the energy is finite at the points
MinimiseResult minimise(const Energy& energy, Points& points, const MinimiseLimits& limits);

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
