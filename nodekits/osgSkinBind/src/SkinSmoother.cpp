// SPDX-License-Identifier: GPL-3.0-or-later
#include "SkinSmoother.h"

#include "EdgeWeights.h"

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <queue>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// One step's kernel falls off exponentially and has a cusp in its middle; several shorter steps
/// come near a Gaussian: rounder where the skin bends, and sooner exactly flat.
constexpr int kSteps = 5;

std::vector<double> lumpedMass(const WeldedMesh& mesh) {
    std::vector<double> mass(mesh.vertexCount(), 0.0);
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const double area =
            0.5 * glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        for (const std::uint32_t v : t) mass[v] += area / 3.0;
    }
    // A vertex of zero-area triangles only still needs some mass, as one without any triangle does.
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const double lowest = total > 0.0 ? 1e-6 * total / static_cast<double>(mass.size()) : 1.0;
    for (double& m : mass) m = std::max(m, lowest);
    return mass;
}

/// How far from where a field changes, in widths, its spread is computed. Five steps have a
/// standard deviation of 1.4 widths, so what would come farther is below 1e-3, and is cut off
/// anyway.
constexpr double kReach = 4.0;

/// Vertices within kReach of an edge whose ends differ, by the length of the way over the mesh.
std::vector<std::uint32_t> whereItChanges(const WeldedMesh& mesh, const std::vector<double>& field,
                                          const std::vector<double>& widths) {
    using Step = std::pair<double, std::uint32_t>; // length, vertex
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    std::vector<double> length(mesh.vertexCount(), kReach);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i)
            if (field[mesh.neighbours[i]] != field[v] && length[v] > 0.0) {
                length[v] = 0.0;
                front.emplace(0.0, v);
            }
    std::vector<std::uint32_t> reached;
    while (!front.empty()) {
        const auto [here, v] = front.top();
        front.pop();
        if (here > length[v]) continue; // come to on a shorter way
        reached.push_back(v);
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            const double step = 2.0 * glm::distance(mesh.positions[v], mesh.positions[next]) /
                                (widths[v] + widths[next]);
            if (here + step >= length[next]) continue;
            length[next] = here + step;
            front.emplace(length[next], next);
        }
    }
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    return reached;
}

} // namespace

SkinSmoother::SkinSmoother(const WeldedMesh& mesh)
    : _mesh(mesh), _mass(lumpedMass(mesh)), _weights(edgeWeights(mesh)) {}

void SkinSmoother::smooth(std::vector<double>& field, double width) const {
    if (width > 0.0) smooth(field, std::vector<double>(field.size(), width));
}

void SkinSmoother::smooth(std::vector<double>& field, const std::vector<double>& widths) const {
    const std::vector<std::uint32_t> patch = whereItChanges(_mesh, field, widths);
    if (patch.empty()) return;
    std::vector<int> row(field.size(), -1);
    for (std::size_t i = 0; i < patch.size(); ++i) row[patch[i]] = static_cast<int>(i);

    const auto count = static_cast<Eigen::Index>(patch.size());
    Vector mass(count), values(count);
    std::vector<Eigen::Triplet<double>> entries; // of M + tau L
    for (Eigen::Index i = 0; i < count; ++i) {
        const std::uint32_t v = patch[static_cast<std::size_t>(i)];
        values[i] = field[v];
        mass[i] = _mass[v] / widths[v];
        double diagonal = mass[i];
        for (std::uint32_t k = _mesh.firstNeighbour[v]; k < _mesh.firstNeighbour[v + 1]; ++k) {
            const std::uint32_t next = _mesh.neighbours[k];
            if (row[next] < 0) continue;
            const double weight = _weights[k] * (widths[v] + widths[next]) / (2.0 * kSteps);
            entries.emplace_back(static_cast<int>(i), row[next], -weight);
            diagonal += weight;
        }
        entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal);
    }
    Matrix heatStep(count, count);
    heatStep.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Matrix> solver(heatStep);
    if (solver.info() != Eigen::Success) return; // leaves the field as hard as it was
    for (int step = 0; step < kSteps; ++step)
        values = solver.solve(mass.cwiseProduct(values)).eval();
    for (Eigen::Index i = 0; i < count; ++i) field[patch[static_cast<std::size_t>(i)]] = values[i];
}

} // namespace osgSkin
