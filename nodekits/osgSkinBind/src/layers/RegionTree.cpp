// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers/RegionTree.h"

namespace osgSkin {
namespace {

constexpr int kStepsApart = 2;

} // namespace

RegionTree::RegionTree(const std::vector<PlannedJoint>& joints) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto above = static_cast<std::uint32_t>(j == 0 ? 0 : regionAbove(joints, j));
        const bool ofTrunk = j == 0 || joints[j].trunk;
        _above.push_back(above);
        _depths.push_back(ofTrunk ? 0 : _depths[above] + 1);
    }
}

bool RegionTree::mayTouch(std::uint32_t a, std::uint32_t b) const {
    int steps = 0;
    while (a != b && (depth(a) > 0 || depth(b) > 0)) {
        // Two limbs meet in the trunk only.
        if (depth(a) == 1 && depth(b) == 1) return false;
        std::uint32_t& deeper = depth(a) >= depth(b) ? a : b;
        deeper = _above[deeper];
        if (++steps > kStepsApart) return false;
    }
    return true;
}

} // namespace osgSkin
