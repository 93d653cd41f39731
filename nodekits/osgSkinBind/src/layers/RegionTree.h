// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONTREE_H
#define OSGSKINBIND_REGIONTREE_H

#include "joints/JointPlan.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// How near regions are to each other along the limbs.
class RegionTree {
public:
    explicit RegionTree(const std::vector<PlannedJoint>& joints);

    /// True where skin of one region may lie on skin of the other: both of the trunk, or of one
    /// limb and at most two steps apart, the trunk counting as one. A leg's does not lie on the
    /// other leg's, nor a hand's on the hips', however near they are at rest.
    bool mayTouch(std::uint32_t a, std::uint32_t b) const;

private:
    /// Steps from a joint's region to the trunk; 0 of the trunk.
    int depth(std::uint32_t joint) const { return _depths[joint]; }

    std::vector<std::uint32_t> _above; ///< the region that each joint's hangs on
    std::vector<int> _depths;
};

} // namespace osgSkin

#endif
