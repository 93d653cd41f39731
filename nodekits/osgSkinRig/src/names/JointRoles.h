// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointNames>
#include <osgSkinRig/RestSkeleton>

#include <map>
#include <string>
#include <vector>

namespace osgSkin {

/// The roles of a skeleton's joints, by the family of names that fits it best.
struct JointRoles {
    std::string family;                             ///< empty where none fits
    std::vector<std::string> roles;                 ///< [joint], empty for a joint without one
    std::map<std::string, std::vector<int>> joints; ///< role -> its joints, parents first

    bool known() const { return !family.empty(); }
};

/// Finds the family by the number of roles that its names fill, four at least. Where several fill
/// as many, those of `more` go first, the last before the others.
JointRoles findRoles(const RestSkeleton& skeleton, const std::vector<JointNames>& more);

} // namespace osgSkin
