// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/surface/CurveSkeleton.h"

#include <glm/geometric.hpp>

#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace osgSkin {

std::vector<std::size_t> CurveSkeleton::Paths::pathFrom(std::size_t point) const {
    std::vector<std::size_t> path{point};
    while (next[path.back()] != path.back()) path.push_back(next[path.back()]);
    return path;
}

CurveSkeleton::Paths CurveSkeleton::pathsTo(std::size_t from,
                                            const std::vector<bool>& blocked) const {
    Paths paths;
    paths.length.assign(points.size(), std::numeric_limits<double>::infinity());
    for (std::size_t p = 0; p < points.size(); ++p) paths.next.push_back(p);
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    paths.length[from] = 0.0;
    open.emplace(0.0, from);
    while (!open.empty()) {
        const auto [length, p] = open.top();
        open.pop();
        if (length > paths.length[p]) continue;
        for (const std::size_t q : neighbours[p]) {
            const double longer = length + glm::distance(points[p], points[q]);
            if (longer >= paths.length[q] || (!blocked.empty() && blocked[q])) continue;
            paths.length[q] = longer;
            paths.next[q] = p;
            open.emplace(longer, q);
        }
    }
    return paths;
}

} // namespace osgSkin
