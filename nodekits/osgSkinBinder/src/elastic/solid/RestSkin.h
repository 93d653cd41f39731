// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLID_RESTSKIN_H
#define OSGSKINBINDER_ELASTIC_SOLID_RESTSKIN_H

#include "mesh/SurfaceTree.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

/// Points, gradients and displacements, a column each. Unless stated otherwise they are in joint
/// space: relative to the joint's centre, in units of the limb's radius there, y along the bone
/// that moves, x along the main axis of rotation.
using Points = Eigen::Matrix3Xd;
using Point = Eigen::Vector3d;

inline Point toEigen(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

inline glm::dvec3 toGlm(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

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

    /// True if each edge is passed as often one way as the other, so that winding numbers are
    /// whole.
    bool isClosed() const { return _isClosed; }

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
    bool _isClosed;
};

} // namespace osgSkin::elastic

#endif
