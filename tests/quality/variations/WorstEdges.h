// SPDX-License-Identifier: MIT
#pragma once

#include "../PoseSet.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace quality {

/// An edge that is among the longest of its pose, l'/l, and how its ends' ratios differ.
struct WorstEdge {
    compare::Edge edge{};
    std::size_t poses = 0; ///< in which it is among the longest
    double excess = 0.0;   ///< sum over them of l'/l - 1
    double longest = 0.0;  ///< l'/l
    std::string longestIn; ///< that pose's name
};

/// The edges beyond the 99.9th percentile of any of the poses, ours, the largest sum first.
std::vector<WorstEdge> worstEdges(const Subject& subject, const std::vector<NamedPose>& poses);

/// One line on it: painted joints, regions and the joints whose ratios differ most over it.
std::string lineOf(const Subject& subject, const WorstEdge& worst);

} // namespace quality
