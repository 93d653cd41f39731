// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHELLSURFACE_H
#define OSGSKINBIND_SHELLSURFACE_H

#include "mesh/WeldedMesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace osgSkin {

/// A point of the skin.
struct SurfacePoint {
    std::array<std::uint32_t, 3> corners; ///< welded vertices
    glm::dvec3 shares{0.0};               ///< at least 0, sum 1
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0}; ///< of the corners, in these shares; unit or zero

    std::uint32_t nearestCorner() const {
        const auto& s = shares;
        return corners[s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2];
    }
};

/// One shell of a skin, to find its points near others.
class ShellSurface {
public:
    /// \param mesh is referred to
    /// \param shell index of the shell
    ShellSurface(const WeldedMesh& mesh, std::uint32_t shell);
    ~ShellSurface();
    ShellSurface(const ShellSurface&) = delete;

    /// The nearest point; none where no triangle has an area, or the nearest is farther than
    /// `reach`. From one thread at a time.
    std::optional<SurfacePoint> nearest(const glm::dvec3& point, double reach) const;

private:
    struct Tree;
    const WeldedMesh& _mesh;
    std::unique_ptr<Tree> _tree;
};

} // namespace osgSkin

#endif
