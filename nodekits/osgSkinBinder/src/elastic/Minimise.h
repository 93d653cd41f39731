// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_MINIMISE_H
#define OSGSKINBINDER_ELASTIC_MINIMISE_H

#include "elastic/solid/RestSkin.h"

#include <functional>

namespace osgSkin::elastic {

/// Directions of descent and what they are made of, in single precision: only the points and the
/// energy are accurate.
using Directions = Eigen::Matrix3Xf;

/// An energy for minimise().
struct Energy {
    /// Value at the points, infinite where it is not defined; writes its gradient.
    std::function<double(const Points& at, Points& gradient)> value;
    /// An approximate inverse Hessian times a gradient: a displacement.
    std::function<Directions(const Directions& gradient)> precondition;
    /// Called every few steps before the value is computed again; may change the energy.
    std::function<void(const Points& at)> renew;
};

struct MinimiseLimits {
    int mostSteps = 20;
    int renewEvery = 10;     ///< steps
    double smallStep = 1e-3; ///< largest displacement of a point that counts as rest
};

/// L-BFGS (Nocedal & Wright 2006, algorithm 7.4) with the preconditioner as initial inverse
/// Hessian, and backtracking.
/// \pre the energy is finite at the points
/// \return the number of steps: less than the most if the points came to rest
int minimise(const Energy& energy, Points& points, const MinimiseLimits& limits);

} // namespace osgSkin::elastic

#endif
