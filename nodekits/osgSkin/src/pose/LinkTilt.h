// SPDX-License-Identifier: MIT
#pragma once

#include "model/GradientBlocks.h"

#include <cmath>

namespace osgSkin {

/// Which changes along a partial link's ratios tilt a group's normals in a pose so far that anybody
/// could see it; the others are left out.
struct LinkTilt {
    static constexpr double kLeast = 1e-3; ///< radians

    bool bends = false;  ///< those of the bend ratio
    bool twists = false; ///< those of the twist ratio
    bool moves = false;  ///< those of the joint's translation and scale, which come with the bend

    bool any() const { return bends || twists || moves; }
};

/// \param bendAngle psi
/// \param twistAngle phi
/// \param moves whether the joint is moved or scaled
inline LinkTilt linkTilt(const GradientBlocks::Reach& reach, double bendAngle, double twistAngle,
                         bool moves) noexcept {
    return {std::abs(bendAngle) * static_cast<double>(reach.bend) > LinkTilt::kLeast,
            std::abs(twistAngle) * static_cast<double>(reach.twist) > LinkTilt::kLeast, moves};
}

} // namespace osgSkin
