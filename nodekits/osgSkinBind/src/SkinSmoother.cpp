// SPDX-License-Identifier: GPL-3.0-or-later
#include "SkinSmoother.h"

#include "EdgeWeights.h"

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// One step's kernel falls off exponentially and has a cusp in its middle; several shorter steps
/// come near a Gaussian: rounder where the skin bends, and sooner exactly flat.
constexpr int kSteps = 5;

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
    const std::vector<double> weights = edgeWeights(mesh);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        entries.emplace_back(static_cast<int>(v), static_cast<int>(v), 0.0); // one without edges
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            entries.emplace_back(static_cast<int>(v), static_cast<int>(mesh.neighbours[i]),
                                 -weights[i]);
            entries.emplace_back(static_cast<int>(v), static_cast<int>(v), weights[i]);
        }
    }
    const auto n = static_cast<Eigen::Index>(mesh.vertexCount());
    Matrix result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

} // namespace

struct SkinSmoother::System {
    Vector mass;
    Matrix laplace;
    Eigen::SimplicialLDLT<Matrix> solver;

    /// M + tau L, for mass and weights in units of the widths.
    Matrix heatStep(const Vector& massInWidths, const std::vector<double>& widths) const;
};

Matrix SkinSmoother::System::heatStep(const Vector& massInWidths,
                                      const std::vector<double>& widths) const {
    Matrix step = laplace;
    for (Eigen::Index v = 0; v < step.outerSize(); ++v) {
        double* diagonal = nullptr;
        double sum = 0.0;
        for (Matrix::InnerIterator entry(step, v); entry; ++entry) {
            if (entry.row() == v) {
                diagonal = &entry.valueRef();
                continue;
            }
            entry.valueRef() *= (widths[static_cast<std::size_t>(v)] +
                                 widths[static_cast<std::size_t>(entry.row())]) /
                                (2.0 * kSteps);
            sum -= entry.value();
        }
        *diagonal = massInWidths[v] + sum;
    }
    return step;
}

SkinSmoother::SkinSmoother(const WeldedMesh& mesh) : _system(std::make_unique<System>()) {
    _system->mass = lumpedMass(mesh);
    _system->laplace = laplacian(mesh);
    // The pattern is the same for every width: ordering it once is half of the work.
    _system->solver.analyzePattern(_system->laplace);
}

SkinSmoother::~SkinSmoother() = default;

void SkinSmoother::smooth(std::vector<double>& field, double width) const {
    if (width > 0.0) smooth(field, std::vector<double>(field.size(), width));
}

void SkinSmoother::smooth(std::vector<double>& field, const std::vector<double>& widths) const {
    const auto count = static_cast<Eigen::Index>(field.size());
    const Vector mass = _system->mass.cwiseQuotient(Eigen::Map<const Vector>(widths.data(), count));
    _system->solver.factorize(_system->heatStep(mass, widths));
    if (_system->solver.info() != Eigen::Success) return; // leaves the field as hard as it was
    Eigen::Map<Vector> values(field.data(), count);
    for (int step = 0; step < kSteps; ++step)
        values = _system->solver.solve(mass.cwiseProduct(values)).eval();
}

} // namespace osgSkin
