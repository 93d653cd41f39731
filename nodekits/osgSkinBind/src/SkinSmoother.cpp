// SPDX-License-Identifier: GPL-3.0-or-later
#include "SkinSmoother.h"

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// One step's kernel falls off exponentially and has a cusp in its middle; several shorter steps
/// come near a Gaussian: rounder where the skin bends, and sooner exactly flat.
constexpr int kSteps = 3;

/// Bounds of an edge's weight. The lower one keeps needles connected and the values in range.
constexpr double kLowestWeight = 1e-3;
constexpr double kHighestWeight = 50.0;

/// Cotangent of the angle at `a`; 0 where the triangle has no angle.
double cotangent(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double twiceArea = glm::length(glm::cross(b - a, c - a));
    return twiceArea > 0.0 ? glm::dot(b - a, c - a) / twiceArea : 0.0;
}

Vector lumpedMass(const WeldedMesh& mesh) {
    Vector mass = Vector::Zero(static_cast<Eigen::Index>(mesh.vertexCount()));
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const double area =
            0.5 * glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        for (const std::uint32_t v : t) mass[v] += area / 3.0;
    }
    // A vertex of zero-area triangles only still needs some mass, as one without any triangle does.
    const double total = mass.sum();
    const double lowest = total > 0.0 ? 1e-6 * total / static_cast<double>(mass.size()) : 1.0;
    return mass.cwiseMax(lowest);
}

Matrix laplacian(const WeldedMesh& mesh) {
    const auto n = static_cast<Eigen::Index>(mesh.vertexCount());
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto i = static_cast<int>(t[k]), j = static_cast<int>(t[(k + 1) % 3]);
            const double half =
                0.5 * cotangent(mesh.positions[t[(k + 2) % 3]], mesh.positions[t[k]],
                                mesh.positions[t[(k + 1) % 3]]);
            entries.emplace_back(std::min(i, j), std::max(i, j), half);
        }
    Matrix edges(n, n);
    edges.setFromTriplets(entries.begin(), entries.end()); // sums both sides of an edge
    entries.clear();
    for (int column = 0; column < edges.outerSize(); ++column)
        for (Matrix::InnerIterator it(edges, column); it; ++it) {
            const int i = static_cast<int>(it.row()), j = static_cast<int>(it.col());
            const double weight = std::clamp(it.value(), kLowestWeight, kHighestWeight);
            entries.emplace_back(i, j, -weight);
            entries.emplace_back(j, i, -weight);
            entries.emplace_back(i, i, weight);
            entries.emplace_back(j, j, weight);
        }
    Matrix result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

} // namespace

struct SkinSmoother::System {
    Vector mass;
    Matrix massMatrix;
    Matrix laplace;
    Eigen::SimplicialLDLT<Matrix> solver;
};

SkinSmoother::SkinSmoother(const WeldedMesh& mesh) : _system(std::make_unique<System>()) {
    _system->mass = lumpedMass(mesh);
    _system->laplace = laplacian(mesh);
    _system->massMatrix = Matrix(_system->mass.asDiagonal());
    // The pattern is the same for every width: ordering it once is half of the work.
    _system->solver.analyzePattern(_system->massMatrix + _system->laplace);
}

SkinSmoother::~SkinSmoother() = default;

void SkinSmoother::smooth(std::vector<double>& field, double width) const {
    if (!(width > 0.0)) return;
    const double tau = width * width / kSteps;
    _system->solver.factorize(_system->massMatrix + tau * _system->laplace);
    if (_system->solver.info() != Eigen::Success) return; // leaves the field as hard as it was
    Eigen::Map<Vector> values(field.data(), static_cast<Eigen::Index>(field.size()));
    for (int step = 0; step < kSteps; ++step)
        values = _system->solver.solve(_system->mass.cwiseProduct(values)).eval();
}

} // namespace osgSkin
