// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <string>
#include <vector>

namespace osgSkin {

/// Settles roles by the tree: one joint a role, the topmost, but for spine and neck, which are the
/// joints on the line up to the head; the hips carry both legs; a head without a name of its own is
/// the last of the spine's joints above the arms.
/// \param roles [joint] as in JointNames, empty for none
void settleRoles(const RestSkeleton& skeleton, std::vector<std::string>& roles);

/// The lowest joint that both stand below, or are; -1 for none.
int commonAncestor(const RestSkeleton& skeleton, int a, int b);

} // namespace osgSkin
