// SPDX-License-Identifier: MIT
#pragma once

#include "names/NameReading.h"

#include <osgSkinRig/RestSkeleton>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// How a skeleton's names read, joint by joint, and the roles that follow (as in JointNames).
struct WordRoles {
    std::vector<std::optional<NameReading>> readings; ///< [joint]
    std::vector<std::string> roles;                   ///< [joint]; empty: no role
};

/// Tells roles by the words in the joints' names, whoever gave them.
///
/// Of all prefixes, the one goes that most roles share; names under others are of other things. A
/// word that skeletons use differently ("shoulder", "arm", "leg", "hip") means what is left for it
/// beside the skeleton's other words. Of several joints of one role the topmost has it; the joint
/// that carries both legs is the hips, whatever its name.
/// \param skeleton its names and parents are read
WordRoles wordRoles(const RestSkeleton& skeleton);

} // namespace osgSkin
