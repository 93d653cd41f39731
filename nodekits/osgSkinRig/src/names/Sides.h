// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_NAMES_SIDES_H
#define OSGSKINRIG_NAMES_SIDES_H

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

namespace osgSkin {

/// Whether a skeleton that stands at rest has its toes behind it, as its left and right tell the
/// front. Some authors name sides as they see them from the front.
bool areSidesExchanged(const RestSkeleton& skeleton, const JointRoles& roles);

/// Exchanges the roles of left and right joints.
void exchangeSides(JointRoles& roles);

} // namespace osgSkin

#endif
