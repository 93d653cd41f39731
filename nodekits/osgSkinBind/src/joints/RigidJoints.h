// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RIGIDJOINTS_H
#define OSGSKINBIND_RIGIDJOINTS_H

#include <osgSkinBind/BindOptions>
#include <osgSkinRig/RestSkeleton>

#include <vector>

namespace osgSkin {

/// For each joint the topmost rigid joint at or above it, -1 where there is none.
/// \throw osgSkin::Error where an option names a joint that is not there
std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options);

} // namespace osgSkin

#endif
