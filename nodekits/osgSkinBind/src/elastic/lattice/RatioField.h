// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_RATIOFIELD_H
#define OSGSKINBIND_ELASTIC_RATIOFIELD_H

#include "elastic/lattice/SkinPatch.h"

#include <Eigen/Geometry>

namespace osgSkin::elastic {

/// The joint's bend ratio within the flesh: as harmonic over the nodes as the skin's ratios allow.
/// 0 to 1, one for each node.
Eigen::VectorXd ratioField(const VoxelLattice& lattice, const SkinPatch& patch);

/// Each point turned about the joint by its ratio of a rotation.
Points turned(const Points& points, const Eigen::VectorXd& ratios, const Eigen::Quaterniond& by);

} // namespace osgSkin::elastic

#endif
