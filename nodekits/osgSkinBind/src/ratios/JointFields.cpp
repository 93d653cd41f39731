// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/JointFields.h"

#include <algorithm>

namespace osgSkin {

void raiseParents(const std::vector<PlannedJoint>& joints, JointFields& fields) {
    for (std::size_t j = joints.size(); j-- > 1;) {
        if (joints[j].belowRigid(static_cast<int>(j))) continue;
        std::vector<double>& parent = fields[static_cast<std::size_t>(joints[j].parent)];
        for (std::size_t v = 0; v < parent.size(); ++v)
            parent[v] = std::max(parent[v], fields[j][v]);
    }
}

} // namespace osgSkin
