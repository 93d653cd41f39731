// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_REGIONLABELS_H
#define OSGSKINBIND_REGIONS_REGIONLABELS_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Every welded vertex's region (paper, section 1).
struct Regions {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<std::uint32_t> jointOf; ///< joint index of each welded vertex
    std::vector<std::uint32_t> seedOf;  ///< the Delaunay step's label, kNone without one
    /// For each vertex, whether its shell is wholly of its joint: no plane divides it. Empty: none.
    std::vector<bool> isWhole;
    std::vector<std::size_t> seeds; ///< for each joint, vertices labelled by the Delaunay step
    std::size_t rejectedEdges = 0;  ///< by normal filtering
};

} // namespace osgSkin

#endif
