// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SOLID_SOLIDGRID_H
#define OSGSKINBIND_FIT_SOLID_SOLIDGRID_H

#include "fit/solid/ClosedShells.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin::fit {

/// What shells fill together, as cubes of a grid.
class SolidGrid {
public:
    /// \param low least corner of what is filled, rest space
    /// \param high greatest corner
    /// \param cells along the longest side
    SolidGrid(const glm::dvec3& low, const glm::dvec3& high, int cells);

    const glm::ivec3& size() const { return _size; }
    bool solid(const glm::ivec3& cell) const { return _solid[index(cell)] != 0; }
    glm::dvec3 centre(const glm::dvec3& cell) const { return _origin + _edge * (cell + 0.5); }
    double edge() const { return _edge; }
    std::size_t count() const;

    /// Fills the cubes about whose centre the shell winds.
    void add(const ClosedShell& shell);

    /// Fills what is enclosed but for gaps that are up to six cubes wide: a jacket without a body
    /// in it.
    void fillPockets();

    /// Joins shells that lie near each other where they are nearest, as a tree, and drops what is
    /// far away or hardly there.
    /// \return the number of gaps that were bridged
    int join();

    /// Fills cubes where others touch along an edge or at a corner only, so that the surface has
    /// two sides everywhere.
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

    glm::dvec3 _origin;
    double _edge;
    glm::ivec3 _size;
    std::vector<std::uint8_t> _solid;
    std::vector<std::uint32_t> _shellOf; ///< of solid cubes the first that filled it, from 1; or 0
    std::uint32_t _shells = 0;
};

} // namespace osgSkin::fit

#endif
