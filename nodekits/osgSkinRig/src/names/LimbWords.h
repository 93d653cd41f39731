// SPDX-License-Identifier: MIT
#pragma once

#include "names/NameReading.h"

#include <osgSkinRig/RestSkeleton>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Roles of joints by their words: what "shoulder", "arm", "leg" and "hip" mean is told by the
/// other words on the same side, or by the order of joints that are all called alike.
/// \return [joint] roles as in JointNames, empty for none; several joints may have the same
std::vector<std::string> limbRoles(const RestSkeleton& skeleton,
                                   const std::vector<std::optional<NameReading>>& readings);

} // namespace osgSkin
