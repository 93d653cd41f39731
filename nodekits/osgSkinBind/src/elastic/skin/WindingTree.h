// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_WINDINGTREE_H
#define OSGSKINBIND_ELASTIC_WINDINGTREE_H

#include "elastic/skin/Points.h"
#include "mesh/AngleSum.h"

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

/// Generalised winding number (Jacobson, Kavan & Sorkine-Hornung 2013) of many points: triangles
/// that are far away count as one dipole (Barill et al. 2018). Works in the space of the points
/// that it is given; skins may be open or of several shells. Const after construction, so any
/// number of threads may ask at once.
class WindingTree {
public:
    WindingTree(const Points& positions,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);

    /// How often the skin winds around the point; 1 or -1 within a closed skin, by its winding.
    double at(const Point& point) const;

    /// True where |winding| is above one half.
    bool inside(const Point& point) const;

private:
    struct Node {
        Point centre;                     ///< area-weighted
        Point dipole;                     ///< sum of the triangles' area vectors
        double reach = 0.0;               ///< of the triangles' corners from the centre
        std::uint32_t begin = 0, end = 0; ///< range in _corners
        std::uint32_t child = 0;          ///< of two that stand together; 0 for a leaf
    };
    using Corners = std::array<Point, 3>;

    void split(std::uint32_t node);
    void measure(Node& node) const;
    /// \param halves half of what is near is added to it
    /// \return the solid angle of what is far
    double sum(std::uint32_t node, const Point& point, AngleSum& halves) const;

    std::vector<Corners> _corners;
    std::vector<Node> _nodes;
};

} // namespace osgSkin::elastic

#endif
