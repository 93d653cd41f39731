// SPDX-License-Identifier: GPL-3.0-or-later
#include "bind/CheckInfluences.h"

#include <osgSkin/Error>

#include <algorithm>
#include <string>

namespace osgSkin {

void checkInfluences(const std::vector<PlannedJoint>& joints,
                     const std::vector<std::uint32_t>& regionOf,
                     const std::vector<std::uint32_t>& weldedOf, std::size_t most) {
    if (most == 0) return;
    std::vector<std::size_t> depths(joints.size(), 1); // parents come before their children
    for (std::size_t j = 1; j < joints.size(); ++j)
        depths[j] = depths[static_cast<std::size_t>(joints[j].parent)] + 1;
    std::size_t influences = 0, deepest = 0;
    for (const std::uint32_t v : weldedOf) {
        influences += depths[regionOf[v]];
        deepest = std::max(deepest, depths[regionOf[v]]);
    }
    if (influences > most)
        throw Error("bind: " + std::to_string(weldedOf.size()) +
                    " vertices that follow chains of up to " + std::to_string(deepest) +
                    " joints have " + std::to_string(influences) +
                    " influences together, expected at most " + std::to_string(most) +
                    " (option maxInfluences)");
}

} // namespace osgSkin
