// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/HeatGraph.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace osgSkin {
namespace {

/// Bounds of an edge's weight. The lower one keeps needles connected and the values in range.
constexpr double kLowestWeight = 1e-3;
constexpr double kHighestWeight = 50.0;

/// The penalty of a fully concave edge.
constexpr double kCreaseCost = 30.0;

/// Cotangent of the angle at `a`; 0 in a degenerate triangle.
double cotangent(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double twiceArea = glm::length(glm::cross(b - a, c - a));
    return twiceArea > 0.0 ? glm::dot(b - a, c - a) / twiceArea : 0.0;
}

std::vector<double> lumpedMass(const std::vector<glm::dvec3>& positions,
                               const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::vector<double> mass(positions.size(), 0.0);
    for (const auto& t : triangles) {
        const glm::dvec3& a = positions[t[0]];
        const double area = 0.5 * glm::length(glm::cross(positions[t[1]] - a, positions[t[2]] - a));
        for (const std::uint32_t v : t) mass[v] += area / 3.0;
    }
    // Vertices without a triangle, or with degenerate ones only, need some mass, too.
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const double lowest = total > 0.0 ? 1e-6 * total / static_cast<double>(mass.size()) : 1.0;
    for (double& m : mass) m = std::max(m, lowest);
    return mass;
}

} // namespace

std::vector<double> edgeWeights(const WeldedMesh& mesh) {
    return edgeWeights(mesh.positions, mesh.triangles, mesh.firstNeighbour, mesh.neighbours);
}

std::vector<double> edgeWeights(const std::vector<glm::dvec3>& positions,
                                const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                const std::vector<std::uint32_t>& firstNeighbour,
                                const std::vector<std::uint32_t>& neighbours) {
    const auto entry = [&](std::uint32_t from, std::uint32_t to) {
        const auto begin = neighbours.begin();
        const auto found =
            std::lower_bound(begin + firstNeighbour[from], begin + firstNeighbour[from + 1], to);
        return static_cast<std::size_t>(found - begin);
    };
    std::vector<double> weights(neighbours.size(), 0.0);
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3], opposite = t[(k + 2) % 3];
            const double half = 0.5 * cotangent(positions[opposite], positions[a], positions[b]);
            weights[entry(a, b)] += half;
            weights[entry(b, a)] += half;
        }
    for (double& weight : weights) weight = std::clamp(weight, kLowestWeight, kHighestWeight);
    return weights;
}

double creaseFactor(const WeldedMesh& mesh, std::uint32_t from, std::uint32_t to) {
    const glm::dvec3 edge = mesh.positions[to] - mesh.positions[from];
    const double length = glm::length(edge);
    if (!(length > 0.0)) return 1.0;
    // How far the normals lean towards each other: 0 where flat or convex, up to 2.
    const double lean = glm::dot(mesh.normals[from] - mesh.normals[to], edge) / length;
    return 1.0 + kCreaseCost * std::max(0.0, lean);
}

HeatGraph::HeatGraph(const WeldedMesh& mesh)
    : positions(mesh.positions), triangles(mesh.triangles),
      mass(lumpedMass(mesh.positions, mesh.triangles)), firstNeighbour(mesh.firstNeighbour),
      neighbours(mesh.neighbours), weights(edgeWeights(mesh)) {
    measureEdges();
}

HeatGraph::HeatGraph(std::vector<glm::dvec3> points,
                     std::vector<std::array<std::uint32_t, 3>> faces)
    : positions(std::move(points)), triangles(std::move(faces)),
      mass(lumpedMass(positions, triangles)) {
    listNeighbours(positions.size(), edgesOf(triangles), firstNeighbour, neighbours);
    weights = edgeWeights(positions, triangles, firstNeighbour, neighbours);
    measureEdges();
}

double HeatGraph::edgeLength(std::uint32_t from, std::uint32_t to) const {
    return glm::distance(positions[from], positions[to]);
}

void HeatGraph::measureEdges() {
    double sum = 0.0;
    for (std::uint32_t v = 0; v < vertexCount(); ++v)
        for (const std::uint32_t next : neighboursOf(v)) sum += edgeLength(v, next);
    meanEdge = neighbours.empty() ? 0.0 : sum / static_cast<double>(neighbours.size());
}

} // namespace osgSkin
