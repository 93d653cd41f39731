// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <string>
#include <vector>

namespace osgSkin {

/// Tells roles by the skeleton's shape alone: two pairs of limbs that mirror each other, one above
/// the other along the legs, and a head above the upper one.
///
/// The upper and lower bone of a limb are the two longest in a row. Which side is left is told by
/// the toes, or else taken to be +x. Fingers get no role.
/// \param skeleton at rest; its names are not read
/// \return [joint] roles as in JointNames; empty where it is no figure of a person that stands
std::vector<std::string> shapeRoles(const RestSkeleton& skeleton);

} // namespace osgSkin
