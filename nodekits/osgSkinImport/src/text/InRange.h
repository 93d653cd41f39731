// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_INRANGE_H
#define OSGSKINIMPORT_INRANGE_H 1

#include <osgSkin/GlmTypes>

#include <cmath>

namespace osgSkin {

/// The largest coordinate, either way, of meshes, skeletons, motions and poses (see Pose::set()):
/// what lies beyond is refused, here with its place. Its square is a float still, as the radius of
/// a bound needs it.
constexpr double kLargestCoordinate = 1e18;

/// Whether all components are finite and within kLargestCoordinate.
inline bool isInRange(const glm::dvec3& v) {
    return std::abs(v.x) <= kLargestCoordinate && std::abs(v.y) <= kLargestCoordinate &&
           std::abs(v.z) <= kLargestCoordinate; // false for NaN
}

} // namespace osgSkin

#endif
