// SPDX-License-Identifier: MIT
#ifndef OSGSKIN_REACH_H
#define OSGSKIN_REACH_H 1

#include <osgSkin/GlmTypes>

#include <cmath>

namespace osgSkin {

/// How far joints may stand from the origin, either way; the square is a float still. The kits
/// above keep meshes and motions to the same (osgSkinRig/InRange).
constexpr double kReach = 1e18;

/// Whether all components are finite and within kReach.
inline bool isWithinReach(const glm::dvec3& v) noexcept {
    return std::abs(v.x) <= kReach && std::abs(v.y) <= kReach &&
           std::abs(v.z) <= kReach; // false for NaN
}

} // namespace osgSkin

#endif
