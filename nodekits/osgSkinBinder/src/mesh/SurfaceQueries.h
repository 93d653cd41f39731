// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_SURFACEQUERIES_H
#define OSGSKINBINDER_MESH_SURFACEQUERIES_H

#include "mesh/SurfaceTree.h"
#include "mesh/WeldedMesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgSkin {

/// The shells that contain a point: by their own winding numbers, only closed ones or also those
/// with holes.
std::vector<std::uint32_t> shellsAround(const WeldedMesh& mesh, const glm::dvec3& point,
                                        bool onlyClosed = true);

/// A point of the skin.
struct SurfacePoint {
    std::array<std::uint32_t, 3> corners; ///< welded vertices
    glm::dvec3 shares{0.0};               ///< barycentric: at least 0, sum 1
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0}; ///< interpolated from the corners; unit or zero

    std::uint32_t nearestCorner() const {
        const auto& s = shares;
        return corners[s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2];
    }
};

/// A tree over the triangles of one shell, for closest points.
class ShellSurface {
public:
    /// \param mesh must outlive this
    /// \param shell index of the shell
    ShellSurface(const WeldedMesh& mesh, std::uint32_t shell);

    /// The nearest point; none if it is farther away than `reach`, or if no triangle has an area.
    std::optional<SurfacePoint> nearest(const glm::dvec3& point, double reach) const;

private:
    const WeldedMesh& _mesh;
    std::vector<std::array<std::uint32_t, 3>> _triangles;
    SurfaceTree _tree;
};

} // namespace osgSkin

#endif
