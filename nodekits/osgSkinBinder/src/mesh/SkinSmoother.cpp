// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SkinSmoother.h"

#include "mesh/CoarseGraph.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <queue>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// The kernel of a single step falls off exponentially and has a cusp in its middle. Several
/// shorter steps approximate a Gaussian, which is rounder and becomes exactly flat earlier.
constexpr int kSteps = 5;

/// A coarser skin is used if a width spans at least this many edges. On the coarser skin it still
/// spans four or five, and the field differs from the fine skin's by at most 0.02.
constexpr double kFinest = 12.0;

/// A coarser skin must have at least this many times fewer vertices.
constexpr std::size_t kMinCoarsening = 2;

/// The spread is computed up to this distance, in widths, from changes of the field. Five steps
/// have a standard deviation of 1.4 widths, so values farther away are below 1e-3, which is cut off
/// anyway.
constexpr double kReach = 4.0;

/// Vertices within kReach of an edge whose ends differ, along the skin's edges.
std::vector<std::uint32_t> whereItChanges(const HeatGraph& skin, const std::vector<double>& field,
                                          const std::vector<double>& widths) {
    using Step = std::pair<double, std::uint32_t>; // length, vertex
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    std::vector<double> length(skin.vertexCount(), kReach);
    for (std::uint32_t v = 0; v < skin.vertexCount(); ++v)
        for (const std::uint32_t next : skin.neighboursOf(v))
            if (field[next] != field[v] && length[v] > 0.0) {
                length[v] = 0.0;
                front.emplace(0.0, v);
            }
    std::vector<std::uint32_t> reached;
    while (!front.empty()) {
        const auto [here, v] = front.top();
        front.pop();
        if (here > length[v]) continue; // reached on a shorter path
        reached.push_back(v);
        for (const std::uint32_t next : skin.neighboursOf(v)) {
            const double step = 2.0 * skin.edgeLength(v, next) / (widths[v] + widths[next]);
            if (here + step >= length[next]) continue;
            length[next] = here + step;
            front.emplace(length[next], next);
        }
    }
    std::sort(reached.begin(), reached.end());
    return reached;
}

/// Smooths a field on one level, without coarser copies.
void spread(const HeatGraph& skin, std::vector<double>& field, const std::vector<double>& widths,
            const std::vector<bool>& isHeld) {
    std::vector<std::uint32_t> patch = whereItChanges(skin, field, widths);
    if (!isHeld.empty())
        patch.erase(std::remove_if(patch.begin(), patch.end(),
                                   [&isHeld](std::uint32_t v) { return isHeld[v]; }),
                    patch.end());
    if (patch.empty()) return;
    std::vector<int> row(field.size(), -1);
    for (std::size_t i = 0; i < patch.size(); ++i) row[patch[i]] = static_cast<int>(i);

    const auto count = static_cast<Eigen::Index>(patch.size());
    Vector mass(count), values(count), inflow = Vector::Zero(count);
    std::vector<Eigen::Triplet<double>> entries; // of M + tau L
    for (Eigen::Index i = 0; i < count; ++i) {
        const std::uint32_t v = patch[static_cast<std::size_t>(i)];
        values[i] = field[v];
        mass[i] = skin.mass[v] / widths[v];
        double diagonal = mass[i];
        for (std::uint32_t k = skin.firstNeighbour[v]; k < skin.firstNeighbour[v + 1]; ++k) {
            const std::uint32_t next = skin.neighbours[k];
            const bool isSource = !isHeld.empty() && isHeld[next];
            if (row[next] < 0 && !isSource) continue;
            const double weight = skin.weights[k] * (widths[v] + widths[next]) / (2.0 * kSteps);
            diagonal += weight;
            if (isSource)
                inflow[i] += weight * field[next];
            else
                entries.emplace_back(static_cast<int>(i), row[next], -weight);
        }
        entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal);
    }
    Matrix heatStep(count, count);
    heatStep.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Matrix> solver(heatStep);
    if (solver.info() != Eigen::Success) return; // leaves the field as it was
    for (int step = 0; step < kSteps; ++step)
        values = solver.solve(mass.cwiseProduct(values) + inflow).eval();
    for (Eigen::Index i = 0; i < count; ++i) field[patch[static_cast<std::size_t>(i)]] = values[i];
}

} // namespace

SkinSmoother::SkinSmoother(const WeldedMesh& mesh, double widest) : _skin(mesh) {
    const HeatGraph* finest = &_skin;
    while (finest->meanEdge > 0.0 && widest > kFinest * finest->meanEdge) {
        auto coarse = std::make_unique<CoarseGraph>(*finest);
        if (kMinCoarsening * coarse->graph().vertexCount() > finest->vertexCount()) break;
        finest = &coarse->graph();
        _coarser.push_back(std::move(coarse));
    }
}

SkinSmoother::~SkinSmoother() = default;

void SkinSmoother::smooth(std::vector<double>& field, double width) const {
    if (width > 0.0) smooth(field, std::vector<double>(field.size(), width));
}

void SkinSmoother::smooth(std::vector<double>& field, const std::vector<double>& widths,
                          const std::vector<bool>& isHeld) const {
    smooth(field, widths, isHeld, 0);
}

void SkinSmoother::smooth(std::vector<double>& field, const std::vector<double>& widths,
                          const std::vector<bool>& isHeld, std::size_t level) const {
    const HeatGraph& skin = level > 0 ? _coarser[level - 1]->graph() : _skin;
    const double narrowest = *std::min_element(widths.begin(), widths.end());
    if (level == _coarser.size() || narrowest < kFinest * skin.meanEdge) {
        spread(skin, field, widths, isHeld);
        return;
    }
    const CoarseGraph& coarser = *_coarser[level];
    std::vector<double> coarse = coarser.restricted(field);
    if (isHeld.empty()) {
        smooth(coarse, coarser.restricted(widths), {}, level + 1);
        field = coarser.interpolated(coarse);
        return;
    }
    std::vector<bool> isCoarseHeld;
    for (const double share : coarser.restricted({isHeld.begin(), isHeld.end()}))
        isCoarseHeld.push_back(share > 0.5);
    smooth(coarse, coarser.restricted(widths), isCoarseHeld, level + 1);
    const std::vector<double> spreadOut = coarser.interpolated(coarse);
    for (std::size_t v = 0; v < field.size(); ++v)
        if (!isHeld[v]) field[v] = spreadOut[v];
}

void SkinSmoother::change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                          const Change& change) const {
    this->change(field, isFree, width, change, 0);
}

void SkinSmoother::change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                          const Change& change, std::size_t level) const {
    const HeatGraph& skin = level > 0 ? _coarser[level - 1]->graph() : _skin;
    if (level == _coarser.size() || width < kFinest * skin.meanEdge) {
        change(skin, field, isFree);
        return;
    }
    const CoarseGraph& coarser = *_coarser[level];
    const std::vector<double> before = coarser.restricted(field);
    std::vector<bool> coarseFree;
    for (const double share : coarser.restricted({isFree.begin(), isFree.end()}))
        coarseFree.push_back(share > 0.5);
    std::vector<double> gained = before;
    this->change(gained, coarseFree, width, change, level + 1);
    for (std::size_t v = 0; v < gained.size(); ++v) gained[v] -= before[v];
    gained = coarser.interpolated(gained);
    for (std::size_t v = 0; v < field.size(); ++v)
        if (isFree[v]) field[v] = std::clamp(field[v] + gained[v], 0.0, 1.0);
}

} // namespace osgSkin
