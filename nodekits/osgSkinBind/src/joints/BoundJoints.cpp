// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/BoundJoints.h"

namespace osgSkin {

std::vector<BoundJoint> boundJoints(const RestSkeleton& skeleton,
                                    const std::vector<PlannedJoint>& joints) {
    std::vector<BoundJoint> result;
    for (std::size_t j = 0; j < joints.size(); ++j)
        result.push_back({skeleton.joints[j].name, joints[j].parent, joints[j].centre,
                          joints[j].boneAxis, joints[j].twistAxis});
    return result;
}

} // namespace osgSkin
