// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_MINIMISE_H
#define OSGSKINBIND_ELASTIC_MINIMISE_H

#include "elastic/skin/Points.h"

#include <functional>

namespace osgSkin::elastic {

/// What minimise() needs to know about an energy.
struct Energy {
    /// Value at the points; writes its gradient. Infinity where it is not defined.
    std::function<double(const Points& at, Points& gradient)> value;
    /// About the inverse Hessian times a gradient: a displacement.
    std::function<Points(const Points& gradient)> precondition;
    /// Called every few steps, before the value is taken anew: may change the energy.
    std::function<void(const Points& at)> renew;
};

struct MinimiseLimits {
    int mostSteps = 240;
    int renewEvery = 8;      ///< steps
    double smallStep = 1e-3; ///< largest displacement of a point at which it has come to rest
};

struct MinimiseResult {
    bool converged = false;
    int steps = 0;
    double lastStep = 0.0; ///< largest displacement of a point in the last step
};

/// L-BFGS (Nocedal & Wright 2006, algorithm 7.4) with the given start of the inverse Hessian and
/// backtracking.
/// \pre the energy is finite at the points
MinimiseResult minimise(const Energy& energy, Points& points, const MinimiseLimits& limits);

} // namespace osgSkin::elastic

#endif
