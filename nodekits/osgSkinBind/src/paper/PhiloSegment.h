// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PHILOSEGMENT_H
#define OSGSKINBIND_PHILOSEGMENT_H

namespace osgSkin {

/// t of eq. 5 (paper, section 3): which fraction |h| / |H| of the shortest segment through a point
/// between two planes lies between the point and the upper plane.
///
/// Between parallel planes that segment is the perpendicular. In a wedge it is Philo's line, which
/// depends on the distances to both planes and their angle only.
///
/// \param toUpper distance of the point from the upper plane, in any unit; not negative
/// \param toLower distance from the lower one, in that unit; not negative, and not 0 with `toUpper`
/// \param angle between the planes, where the point is: 0 (parallel) to below pi; radians
double philoShare(double toUpper, double toLower, double angle);

} // namespace osgSkin

#endif
