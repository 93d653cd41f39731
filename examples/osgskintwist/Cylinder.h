// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/MeshPart>
#include <osgSkinRig/SkinMesh>

#include <cstdint>
#include <vector>

namespace twist {

/// A closed cylinder of radius 1 about the z axis, from z = -4 to z = 4, with flat caps.
struct Cylinder {
    static constexpr double kHalfLength = 4.0;
    static constexpr std::uint32_t kSegments = 48; ///< around
    static constexpr std::uint32_t kSteps = 64;    ///< along; even, so one ring lies at z = 0
    static constexpr std::uint32_t kCapRings = 4;  ///< from the middle of a cap to its rim
    static constexpr std::uint32_t kChequersAround = 16;
    static constexpr double kChequerLength = 0.4;

    osgSkin::SkinMesh mesh;                        ///< quads; triangles in the middle of the caps
    osgSkin::MeshPart part;                        ///< with normals, and texture coordinates 0..1
                                                   ///< around and in pairs of chequers along
    std::vector<std::vector<std::uint32_t>> rings; ///< cross-sections of the side, z increasing

    Cylinder();

    /// The ring at z = 0, where the joint is.
    const std::vector<std::uint32_t>& jointRing() const { return rings[kSteps / 2]; }
};

} // namespace twist
