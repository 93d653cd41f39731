// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_POINTS_H
#define OSGSKINBIND_ELASTIC_POINTS_H

#include <Eigen/Core>

namespace osgSkin::elastic {

/// Points, gradients and displacements: a column each. Joint space unless said otherwise: from the
/// joint's centre, in units of the limb's radius there, axes as in rest space.
using Points = Eigen::Matrix3Xd;
using Point = Eigen::Vector3d;

} // namespace osgSkin::elastic

#endif
