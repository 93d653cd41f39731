// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SOLID_RESTSKIN_H
#define OSGSKINBIND_ELASTIC_SOLID_RESTSKIN_H

#include "mesh/AngleSum.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin::elastic {

/// Points, gradients and displacements, a column each. Unless stated otherwise they are in joint
/// space: relative to the joint's centre, in units of the limb's radius there, with the axes of
/// rest space.
using Points = Eigen::Matrix3Xd;
using Point = Eigen::Vector3d;

/// Generalised winding numbers (Jacobson, Kavan & Sorkine-Hornung 2013) of many points: groups of
/// far triangles count as one dipole (Barill et al. 2018). Skins may be open or have several
/// shells. Works in the space of the given positions. Thread-safe: const after construction.
class WindingTree {
public:
    WindingTree(const Points& positions,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);

    /// How often the skin winds around the point: 1 or -1 within a closed skin.
    double at(const Point& point) const;

    /// True if |winding| is above one half.
    bool inside(const Point& point) const;

private:
    struct Node {
        Point centre;                     ///< area-weighted
        Point dipole;                     ///< sum of the triangles' area vectors
        double reach = 0.0;               ///< largest distance of a corner from the centre
        std::uint32_t begin = 0, end = 0; ///< range in _corners
        std::uint32_t child = 0;          ///< first of two neighbours; 0 for a leaf
    };
    using Corners = std::array<Point, 3>;

    void split(std::uint32_t node);
    void measure(Node& node) const;
    /// Adds half the solid angle of near triangles to `halves` and returns that of far ones.
    double sum(std::uint32_t node, const Point& point, AngleSum& halves) const;

    std::vector<Corners> _corners;
    std::vector<Node> _nodes;
};

/// Distances and sides of the skin at rest, in the space of the given positions. Thread-safe: const
/// after construction.
class RestSkin {
public:
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;

    /// The point of the skin that is nearest to a point.
    struct Nearest {
        std::uint32_t triangle = 0;
        Point shares; ///< barycentric coordinates
        double distance = 0.0;
    };

    /// Triangles without area are ignored.
    /// \pre at least one triangle has an area
    RestSkin(Points positions, Triangles triangles);
    ~RestSkin();

    const Points& positions() const { return _positions; }
    const Triangles& triangles() const { return _triangles; }

    double distance(const Point& point) const;
    Nearest nearest(const Point& point) const;

    /// Decided by the generalised winding number.
    bool inside(const Point& point) const;

    /// Negative inside.
    double signedDistance(const Point& point) const;

private:
    struct Tree;
    Points _positions;
    Triangles _triangles;
    std::unique_ptr<Tree> _tree;
};

} // namespace osgSkin::elastic

#endif
