// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/CoarseGraph.h"

#include "mesh/EdgeWeights.h"
#include "mesh/Neighbours.h"

#include <algorithm>

namespace osgSkin {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Edges longer than this many times the mean don't join vertices to a group.
constexpr double kLongest = 2.0;

/// How much of a vertex's value is taken from its neighbours', in one step of Jacobi's method.
constexpr double kRelaxation = 2.0 / 3.0;

/// Steps after interpolation. Each leaves about a tenth of the groups' outlines.
constexpr int kRounding = 3;

template <typename Element>
void keepOne(std::vector<Element>& ofEach) {
    std::sort(ofEach.begin(), ofEach.end());
    ofEach.erase(std::unique(ofEach.begin(), ofEach.end()), ofEach.end());
}

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
    gatherGroups();
    placeGroups();
    connectGroups();
}

void CoarseGraph::gatherGroups() {
    const double longest = kLongest * _fine.meanEdge;
    _groupOf.assign(_fine.vertexCount(), kNoGroup);
    std::uint32_t groups = 0;
    const auto near = [&](std::uint32_t v, auto&& visit) {
        for (std::uint32_t i = _fine.firstNeighbour[v]; i < _fine.firstNeighbour[v + 1]; ++i)
            if (_fine.edgeLength(v, _fine.neighbours[i]) <= longest) visit(_fine.neighbours[i]);
    };
    // First every vertex with none but free neighbours founds a group with them, ...
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v) {
        bool free = _groupOf[v] == kNoGroup;
        near(v, [&](std::uint32_t u) { free = free && _groupOf[u] == kNoGroup; });
        if (!free) continue;
        _groupOf[v] = groups;
        near(v, [&](std::uint32_t u) { _groupOf[u] = groups; });
        ++groups;
    }
    // ... then what is left joins a group beside it.
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
}

void CoarseGraph::placeGroups() {
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v) {
        _graph.positions[_groupOf[v]] += _fine.mass[v] * _fine.positions[v];
        _graph.mass[_groupOf[v]] += _fine.mass[v];
    }
    for (std::size_t g = 0; g < _graph.vertexCount(); ++g) _graph.positions[g] /= _graph.mass[g];
}

void CoarseGraph::connectGroups() {
    for (const auto& t : _fine.triangles) {
        std::array<std::uint32_t, 3> corners = {_groupOf[t[0]], _groupOf[t[1]], _groupOf[t[2]]};
        std::sort(corners.begin(), corners.end());
        if (corners[0] != corners[1] && corners[1] != corners[2])
            _graph.triangles.push_back(corners);
    }
    keepOne(_graph.triangles);

    std::vector<DirectedEdge> edges; // in both directions
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v)
        for (std::uint32_t i = _fine.firstNeighbour[v]; i < _fine.firstNeighbour[v + 1]; ++i)
            if (_groupOf[v] != _groupOf[_fine.neighbours[i]])
                edges.emplace_back(_groupOf[v], _groupOf[_fine.neighbours[i]]);
    keepOne(edges);
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
