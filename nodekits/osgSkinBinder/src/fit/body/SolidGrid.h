// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_BODY_SOLIDGRID_H
#define OSGSKINBINDER_FIT_BODY_SOLIDGRID_H

#include "mesh/WeldedMesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin::fit {

/// The triangles of a closed surface, which may intersect itself.
using ClosedShell = std::vector<std::array<glm::dvec3, 3>>;

/// Splits triangles of a mesh into consistently wound pieces and closes each: stitches seams, and
/// covers holes by fans about their middles. So winding numbers are integers, whatever flaws the
/// mesh has.
std::vector<ClosedShell> closedShells(const WeldedMesh& mesh,
                                      const std::vector<std::array<std::uint32_t, 3>>& triangles);

/// The volume inside any of several shells, as cubes of a grid.
class SolidGrid {
public:
    /// \param low least corner of the shells, rest space
    /// \param high greatest corner
    /// \param cells along the longest side
    SolidGrid(const glm::dvec3& low, const glm::dvec3& high, int cells);

    const glm::ivec3& size() const { return _size; }
    bool solid(const glm::ivec3& cell) const { return _solid[index(cell)] != 0; }
    glm::dvec3 centre(const glm::dvec3& cell) const { return _origin + _edge * (cell + 0.5); }
    double edge() const { return _edge; }
    std::size_t count() const;

    /// Fills the cubes whose centres the shell winds around.
    void add(const ClosedShell& shell);

    /// Fills volumes that are enclosed but for gaps up to six cubes wide, such as an empty jacket.
    void fillPockets();

    /// Joins shells that are near each other where they are nearest, as a tree, and drops small
    /// shells that are far away.
    /// \return the number of bridged gaps
    int join();

    /// Fills cubes where others touch at an edge or a corner only, so that the surface is manifold.
    void thickenTouches();

private:
    std::size_t index(const glm::ivec3& c) const {
        return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(_size.y) +
                static_cast<std::size_t>(c.y)) *
                   static_cast<std::size_t>(_size.x) +
               static_cast<std::size_t>(c.x);
    }
    glm::ivec3 cellAt(std::size_t index) const;
    bool contains(const glm::ivec3& c) const;
    template <typename Use>
    void forEachNeighbour(std::size_t at, const Use& use) const;
    std::vector<std::uint8_t> distances(int most) const;
    void addBall(std::size_t at, int radius);
    std::vector<std::size_t> fillShells(std::vector<std::uint32_t>& shell) const;
    void dropCrumbs(const std::vector<std::uint32_t>& shell, const std::vector<std::size_t>& sizes);

    glm::dvec3 _origin;
    double _edge;
    glm::ivec3 _size;
    std::vector<std::uint8_t> _solid;
    std::vector<std::uint32_t> _shellOf; ///< the first shell that filled the cube, from 1; or 0
    std::uint32_t _shells = 0;
};

} // namespace osgSkin::fit

#endif
