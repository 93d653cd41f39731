// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_CONTRACTION_H
#define OSGSKINBIND_CONTRACTION_H

#include "muscles/Muscle.h"

#include <vector>

namespace osgSkin {

/// The length of a muscle, over its length at rest, that counts as fully shortened.
constexpr double kShortest = 0.6;

/// How far a muscle is shortened when its hinge is bent: a = (1 / lambda - 1) / (1 / 0.6 - 1), with
/// lambda its length over that at rest; 0 at rest, 1 fully, below 0 where it is stretched.
/// \param psi the hinge's bend from its rest pose, radians; above 0 flexes
double contractionAt(const Muscle& muscle, double psi);

/// The same as the coefficients of the hinge's functions.
std::vector<double> contractionCoefficients(const Muscle& muscle);

} // namespace osgSkin

#endif
