// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/TrunkByShape.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// A long chain's length over the mesh's size: more than a hand with its fingers or a foot has, and
/// less than an arm.
constexpr double kLongChain = 0.18;

/// A collar bone's length over the upper arm's, at most.
constexpr double kCollarBone = 0.8;

} // namespace

std::vector<bool> trunkByShape(const std::vector<PlannedJoint>& joints, double size) {
    std::vector<double> below(joints.size()); // the longest chain from each joint's centre
    std::vector<int> longChains(joints.size(), 0);
    std::vector<bool> trunk(joints.size());
    for (std::size_t j = joints.size(); j-- > 0;) {
        below[j] = std::max(below[j], joints[j].boneLength);
        trunk[j] = trunk[j] || joints[j].trunk || longChains[j] > 1;
        if (joints[j].parent < 0) continue;
        const auto parent = static_cast<std::size_t>(joints[j].parent);
        if (trunk[j]) trunk[parent] = true;
        if (below[j] > kLongChain * size) ++longChains[parent];
        below[parent] = std::max(below[parent],
                                 glm::distance(joints[parent].centre, joints[j].centre) + below[j]);
    }
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (trunk[j] || joints[j].child < 0) continue;
        const double next = joints[static_cast<std::size_t>(joints[j].child)].boneLength;
        if (longChains[static_cast<std::size_t>(joints[j].parent)] > 1 &&
            joints[j].boneLength < kCollarBone * next)
            trunk[j] = true;
    }
    return trunk;
}

} // namespace osgSkin
