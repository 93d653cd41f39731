// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_CURVESKELETON_H
#define OSGSKINBIND_FIT_CURVESKELETON_H

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// A body's medial curves: a graph that runs through the middle of trunk, limbs and head.
struct CurveSkeleton {
    std::vector<glm::dvec3> points;
    std::vector<std::vector<std::size_t>> neighbours;

    /// Shortest path along the curves from each point to `from`, as a tree: the next point on it
    /// (`from` itself for `from`) and its length; infinite where there is none. Points for which
    /// `blocked` is true are not entered.
    struct Paths {
        std::vector<std::size_t> next;
        std::vector<double> length;
        std::vector<std::size_t> pathFrom(std::size_t point) const;
    };
    Paths pathsTo(std::size_t from, const std::vector<bool>& blocked = {}) const;
};

} // namespace osgSkin

#endif
