// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/NearestPoints.h"

#include <CGAL/Orthogonal_incremental_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace osgSkin {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Entry = std::pair<Kernel::Point_3, std::uint32_t>; // with its index
using Traits = CGAL::Search_traits_adapter<Entry, CGAL::First_of_pair_property_map<Entry>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_incremental_neighbor_search<Traits>;

/// CGAL visits neighbours by rounded distances. Those this much farther may still be as near.
constexpr double kRounding = 1.0 + 1e-12;

Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

} // namespace

std::vector<std::uint32_t> nearestPoints(const std::vector<glm::dvec3>& points,
                                         const std::vector<std::uint32_t>& candidates,
                                         const std::vector<std::uint32_t>& queries) {
    std::vector<Entry> entries;
    entries.reserve(candidates.size());
    for (const std::uint32_t c : candidates) entries.emplace_back(toCgal(points[c]), c);
    const Search::Tree tree(entries.begin(), entries.end());

    std::vector<std::uint32_t> result;
    result.reserve(queries.size());
    for (const std::uint32_t q : queries) {
        const Search search(tree, toCgal(points[q]));
        const auto rank = [&](std::uint32_t c) {
            const glm::dvec3 d = points[c] - points[q];
            return std::pair(glm::dot(d, d), c);
        };
        std::pair best = rank(search.begin()->first.second);
        for (auto found = search.begin();
             found != search.end() && found->second <= kRounding * best.first; ++found)
            best = std::min(best, rank(found->first.second));
        result.push_back(best.second);
    }
    return result;
}

} // namespace osgSkin
