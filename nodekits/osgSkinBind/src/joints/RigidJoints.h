// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTS_RIGIDJOINTS_H
#define OSGSKINBIND_JOINTS_RIGIDJOINTS_H

#include <osgSkinBind/BindOptions>
#include <osgSkinBind/RigidJoints>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// The topmost heads, hands and feet, in joint order; never the root, so that something bends.
///
/// \param skeleton valid
/// \param roles of its joints
std::vector<std::size_t> extremities(const RestSkeleton& skeleton, const JointRoles& roles);

/// For each joint the topmost rigid joint at or above it, -1 where there is none.
///
/// \param skeleton valid
/// \param options which joints are rigid, if the author said so
/// \throw osgSkin::Error where an option names a joint that is not there
std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options);

} // namespace osgSkin

#endif
