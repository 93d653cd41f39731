// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_RESTSKIN_H
#define OSGSKINBIND_ELASTIC_RESTSKIN_H

#include "elastic/skin/Points.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin::elastic {

/// The skin at rest, asked for distances and sides. In the space of the positions that it is given.
/// Const after construction: any number of threads may ask at once.
class RestSkin {
public:
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;

    /// The point of the skin that is nearest to some point.
    struct Nearest {
        std::uint32_t triangle = 0;
        Point shares; ///< of the triangle's corners, sum 1
        double distance = 0.0;
    };

    /// Triangles without area are left out of the answers.
    /// \pre at least one triangle has an area
    RestSkin(Points positions, Triangles triangles);
    ~RestSkin();

    const Points& positions() const { return _positions; }
    const Triangles& triangles() const { return _triangles; }

    double distance(const Point& point) const;
    Nearest nearest(const Point& point) const;

    /// Within the skin, told by the generalised winding number.
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
