// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace osgSkin {

/// Which coordinate axis a direction is within 37 degrees of: 1 to 3, negative for the other way;
/// 0: none, or no direction.
inline int nearAxis(const glm::dvec3& direction) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) > 0.8 * glm::length(direction))
            return direction[axis] > 0.0 ? axis + 1 : -axis - 1;
    return 0;
}

} // namespace osgSkin
