// SPDX-License-Identifier: MIT
#include "Subdivide.h"

#include <map>
#include <utility>

namespace bench {
namespace {

/// Finds or makes the vertices of one triangle's grid.
class Grid {
public:
    Grid(Subdivided& result, std::uint32_t parts) : _result(result), _parts(parts) {}

    /// The vertex i parts of the way from corner 0 to 1 and j parts from corner 0 to 2.
    std::uint32_t at(const std::uint32_t* corner, std::uint32_t i, std::uint32_t j) {
        const std::array<std::uint32_t, 3> part = {_parts - i - j, i, j};
        for (std::size_t k = 0; k < 3; ++k)
            if (part[k] == _parts) return corner[k];
        for (std::size_t k = 0; k < 3; ++k)
            if (part[k] == 0)
                return onEdge(corner[(k + 1) % 3], corner[(k + 2) % 3], part[(k + 2) % 3]);
        return add({corner[0], corner[1], corner[2]}, part);
    }

private:
    std::uint32_t onEdge(std::uint32_t from, std::uint32_t to, std::uint32_t part) {
        if (from > to) {
            std::swap(from, to);
            part = _parts - part;
        }
        const auto first = static_cast<std::uint32_t>(_result.vertices.size());
        const auto [entry, isNew] = _edges.try_emplace({from, to}, first);
        if (isNew)
            for (std::uint32_t p = 1; p < _parts; ++p) add({from, to, to}, {_parts - p, p, 0});
        return entry->second + part - 1;
    }

    std::uint32_t add(const std::array<std::uint32_t, 3>& corner,
                      const std::array<std::uint32_t, 3>& part) {
        Blend blend;
        blend.corner = corner;
        for (std::size_t k = 0; k < 3; ++k)
            blend.share[k] = static_cast<double>(part[k]) / static_cast<double>(_parts);
        _result.vertices.push_back(blend);
        return static_cast<std::uint32_t>(_result.vertices.size() - 1);
    }

    Subdivided& _result;
    std::uint32_t _parts;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> _edges;
};

} // namespace

Subdivided subdivide(const std::vector<std::uint32_t>& triangles, std::size_t vertices,
                     std::uint32_t parts) {
    Subdivided result;
    for (std::uint32_t v = 0; v < vertices; ++v)
        result.vertices.push_back({{v, v, v}, {1.0, 0.0, 0.0}});
    Grid grid(result, parts);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const std::uint32_t* corner = &triangles[t];
        // Keeps one row of the grid's vertices, so that inner ones are made once.
        std::vector<std::uint32_t> row, next;
        for (std::uint32_t i = 0; i <= parts; ++i) row.push_back(grid.at(corner, i, 0));
        for (std::uint32_t j = 1; j <= parts; ++j, row.swap(next)) {
            next.clear();
            for (std::uint32_t i = 0; i + j <= parts; ++i) next.push_back(grid.at(corner, i, j));
            for (std::uint32_t i = 0; i < next.size(); ++i) {
                result.triangles.insert(result.triangles.end(), {row[i], row[i + 1], next[i]});
                if (i + 1 < next.size())
                    result.triangles.insert(result.triangles.end(),
                                            {row[i + 1], next[i + 1], next[i]});
            }
        }
    }
    return result;
}

} // namespace bench
