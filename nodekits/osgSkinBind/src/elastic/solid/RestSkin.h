// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SOLID_RESTSKIN_H
#define OSGSKINBIND_ELASTIC_SOLID_RESTSKIN_H

#include "mesh/SurfaceTree.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

/// Points, gradients and displacements, a column each. Unless stated otherwise they are in joint
/// space: relative to the joint's centre, in units of the limb's radius there, with the axes of
/// rest space.
using Points = Eigen::Matrix3Xd;
using Point = Eigen::Vector3d;

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

    const Points& positions() const { return _positions; }
    const Triangles& triangles() const { return _triangles; }

    double distance(const Point& point) const;
    Nearest nearest(const Point& point) const;

    /// Decided by the generalised winding number.
    bool inside(const Point& point) const;

    /// Negative inside.
    double signedDistance(const Point& point) const;

private:
    RestSkin(Points positions, Triangles triangles, const std::vector<glm::dvec3>& corners);

    Points _positions;
    Triangles _triangles;
    SurfaceTree _tree;
    WindingTree _winding;
};

} // namespace osgSkin::elastic

#endif
