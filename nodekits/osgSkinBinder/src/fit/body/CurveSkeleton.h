// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_BODY_CURVESKELETON_H
#define OSGSKINBINDER_FIT_BODY_CURVESKELETON_H

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// A body's medial curves: a graph that runs through the middle of trunk, limbs and head.
struct CurveSkeleton {
    std::vector<glm::dvec3> points;
    std::vector<std::vector<std::size_t>> neighbours;

    /// Shortest paths from each point to one point, as a tree: the next point on the path (the one
    /// point itself for that point) and its length, infinite where there is no path.
    struct Paths {
        std::vector<std::size_t> next;
        std::vector<double> length;
        std::vector<std::size_t> pathFrom(std::size_t point) const;
    };
    /// Does not enter points for which `blocked` is true.
    Paths pathsTo(std::size_t from, const std::vector<bool>& blocked = {}) const;
};

} // namespace osgSkin

#endif
