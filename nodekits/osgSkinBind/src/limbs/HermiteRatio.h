// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_HERMITERATIO_H
#define OSGSKINBIND_HERMITERATIO_H

namespace osgSkin {

/// Eq. 5 (paper, section 3): the ratio at t between a region's upper boundary (0) and its lower one
/// (1), by the cubic Hermite polynomial that is flat at both. Exactly 0 for t <= 0, 1 for t >= 1.
double hermiteRatio(double t);

} // namespace osgSkin

#endif
