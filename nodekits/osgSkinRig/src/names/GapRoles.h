// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <string>
#include <vector>

namespace osgSkin {

/// Gives joints that names do not tell the role that their place in the tree leaves for them: the
/// knee between a thigh and its foot, the foot above the toes, the hand above its fingers or alone
/// below the lower arm, the spine from the hips up to the joint that carries both arms, the neck
/// from there to the head, the collar bone on the way to an arm. Helpers by their names (twists,
/// ends, props) are passed over, and roles that are there stay.
/// \param roles [joint] as in JointNames, empty for none
void fillGaps(const RestSkeleton& skeleton, std::vector<std::string>& roles);

} // namespace osgSkin
