// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SOLID_SURFACENET_H
#define OSGSKINBIND_FIT_SOLID_SURFACENET_H

#include "fit/solid/SolidGrid.h"

#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin::fit {

/// A solid's surface: a vertex for each corner of eight cubes that are not alike, relaxed within
/// half a cube (S. Gibson, *Constrained elastic surface nets*, 1998). Closed, facing outwards.
struct SurfaceNet {
    std::vector<glm::dvec3> points; ///< rest space
    std::vector<std::array<std::size_t, 3>> triangles;

    /// \param grid nowhere touching itself along an edge alone (SolidGrid::thickenTouches())
    explicit SurfaceNet(const SolidGrid& grid);

private:
    void relax(double reach);
};

} // namespace osgSkin::fit

#endif
