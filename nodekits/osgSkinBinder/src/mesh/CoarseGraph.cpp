// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/CoarseGraph.h"

#include <algorithm>
#include <array>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Edges longer than this many times the mean do not join vertices to a group.
constexpr double kLongest = 2.0;

/// Relaxation factor of Jacobi's method.
constexpr double kRelaxation = 2.0 / 3.0;

/// Jacobi steps after interpolation. Each leaves about a tenth of the groups' outlines visible.
constexpr int kRounding = 3;

std::vector<double> relaxed(const HeatGraph& graph, const std::vector<double>& field) {
    std::vector<double> result(field.size());
    for (std::uint32_t v = 0; v < field.size(); ++v) {
        double sum = 0.0, weights = 0.0;
        for (std::uint32_t i = graph.firstNeighbour[v]; i < graph.firstNeighbour[v + 1]; ++i) {
            sum += graph.weights[i] * (field[graph.neighbours[i]] - field[v]);
            weights += graph.weights[i];
        }
        result[v] = weights > 0.0 ? field[v] + kRelaxation * sum / weights : field[v];
    }
    return result;
}

} // namespace

CoarseGraph::CoarseGraph(const HeatGraph& fine) : _fine(fine) {
    makeGroups();
    connectGroups();
}

void CoarseGraph::makeGroups() {
    const double longest = kLongest * _fine.meanEdge;
    _groupOf.assign(_fine.vertexCount(), kNoGroup);
    std::uint32_t groups = 0;
    const auto near = [&](std::uint32_t v, auto&& visit) {
        for (const std::uint32_t next : _fine.neighboursOf(v))
            if (_fine.edgeLength(v, next) <= longest) visit(next);
    };
    // First, a vertex whose neighbours are all free founds a group with them, ...
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v) {
        bool free = _groupOf[v] == kNoGroup;
        near(v, [&](std::uint32_t u) { free = free && _groupOf[u] == kNoGroup; });
        if (!free) continue;
        _groupOf[v] = groups;
        near(v, [&](std::uint32_t u) { _groupOf[u] = groups; });
        ++groups;
    }
    // ... then the remaining vertices join an adjacent group.
    const std::vector<std::uint32_t> founded = _groupOf;
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v)
        if (founded[v] == kNoGroup) {
            double shortest = 0.0;
            near(v, [&](std::uint32_t u) {
                const double length = _fine.edgeLength(v, u);
                if (founded[u] == kNoGroup || (_groupOf[v] != kNoGroup && length >= shortest))
                    return;
                shortest = length;
                _groupOf[v] = founded[u];
            });
        }
    _graph.positions.assign(groups, glm::dvec3(0.0));
    _graph.mass.assign(groups, 0.0);
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v) {
        _graph.positions[_groupOf[v]] += _fine.mass[v] * _fine.positions[v];
        _graph.mass[_groupOf[v]] += _fine.mass[v];
    }
    for (std::size_t g = 0; g < _graph.vertexCount(); ++g) _graph.positions[g] /= _graph.mass[g];
}

void CoarseGraph::connectGroups() {
    using Triangle = std::array<std::uint32_t, 3>;
    Triangle last{};
    std::vector<std::pair<Triangle, Triangle>> sorted; // corners in order, and as they face
    for (const auto& t : _fine.triangles) {
        const Triangle corners = {_groupOf[t[0]], _groupOf[t[1]], _groupOf[t[2]]};
        Triangle key = corners;
        std::sort(key.begin(), key.end());
        if (key[0] != key[1] && key[1] != key[2]) sorted.emplace_back(key, corners);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [key, corners] : sorted)
        if (_graph.triangles.empty() || key != last) {
            _graph.triangles.push_back(corners);
            last = key;
        }

    std::vector<DirectedEdge> edges; // in both directions
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v)
        for (const std::uint32_t next : _fine.neighboursOf(v))
            if (_groupOf[v] != _groupOf[next]) edges.emplace_back(_groupOf[v], _groupOf[next]);
    std::sort(edges.begin(), edges.end());
    listNeighbours(_graph.vertexCount(), edges, _graph.firstNeighbour, _graph.neighbours);
    _graph.weights =
        edgeWeights(_graph.positions, _graph.triangles, _graph.firstNeighbour, _graph.neighbours);
    _graph.measureEdges();
}

std::vector<double> CoarseGraph::restricted(const std::vector<double>& field) const {
    std::vector<double> result(_graph.vertexCount(), 0.0);
    for (std::uint32_t v = 0; v < field.size(); ++v)
        result[_groupOf[v]] += _fine.mass[v] * field[v];
    for (std::size_t g = 0; g < result.size(); ++g) result[g] /= _graph.mass[g];
    return result;
}

std::vector<double> CoarseGraph::interpolated(const std::vector<double>& field) const {
    std::vector<double> result(_fine.vertexCount());
    for (std::uint32_t v = 0; v < result.size(); ++v) result[v] = field[_groupOf[v]];
    for (int i = 0; i < kRounding; ++i) result = relaxed(_fine, result);
    return result;
}

} // namespace osgSkin
