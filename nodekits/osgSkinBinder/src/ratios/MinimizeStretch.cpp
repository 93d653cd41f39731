// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/MinimizeStretch.h"

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// The vertices of edges with one triangle.
std::vector<bool> bordersOf(const HeatGraph& skin) {
    const std::vector<DirectedEdge> edges = edgesOf(skin.triangles);
    std::vector<bool> isBorder(skin.vertexCount());
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next =
            std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
        if (next - edge == 1) isBorder[edge->first] = isBorder[edge->second] = true;
        edge = next;
    }
    return isBorder;
}

/// Weights, relative to the fourth power of the stretch, of the fourth power of the whole change,
/// which includes compression, and of its square, which keeps unstretched skin even.
constexpr double kChange = 0.3;
constexpr double kEven = 0.02;

/// Newton's method ends when a step gains less than this share, or after kNewtonSteps. A step that
/// gains nothing is halved, up to kHalvings times.
constexpr double kMinGain = 1e-3;
constexpr int kNewtonSteps = 12;
constexpr int kHalvings = 6;

/// An edge under one rotation: |e + d u|^2 / |e|^2 = 1 + 2 d along + d^2 square.
struct Turned {
    double along, square;
};

struct TurnedEdge {
    std::uint32_t from, to;
    double weight; ///< area
};

/// An edge's energy and its derivatives by d.
struct EdgeEnergy {
    double value = 0.0, slope = 0.0, curvature = 0.0;
};

void addEnergy(const Turned& edge, double d, EdgeEnergy& sum) {
    const double ratio = std::sqrt(std::max(1e-12, 1.0 + d * (2.0 * edge.along + d * edge.square)));
    if (const double x = ratio - 1.0; x > 0.0) {
        const double growth = (edge.along + d * edge.square) / ratio;
        sum.value += x * x * x * x;
        sum.slope += 4.0 * x * x * x * growth;
        sum.curvature += 12.0 * x * x * growth * growth +
                         4.0 * x * x * x * std::max(0.0, edge.square - growth * growth) / ratio;
    }
    const double change = d * d * edge.square;
    sum.value += kChange * change * change + kEven * change;
    sum.slope += (4.0 * kChange * change + 2.0 * kEven) * d * edge.square;
    sum.curvature += (12.0 * kChange * change + 2.0 * kEven) * edge.square;
}

/// The edges with a free end, each under all rotations, and their energy.
class Stretch {
public:
    Stretch(const HeatGraph& skin, const std::vector<bool>& isFree, const glm::dvec3& centre,
            const std::vector<glm::dvec3>& turns)
        : _turns(turns.size()), _row(isFree.size(), -1) {
        for (std::uint32_t v = 0; v < isFree.size(); ++v)
            if (isFree[v]) {
                _row[v] = static_cast<int>(_free.size());
                _free.push_back(v);
            }
        const auto share = [&skin](std::uint32_t v) {
            return skin.mass[v] / (skin.firstNeighbour[v + 1] - skin.firstNeighbour[v]);
        };
        for (const std::uint32_t v : _free)
            for (const std::uint32_t next : skin.neighboursOf(v)) {
                if (_row[next] >= 0 && next < v) continue;
                const glm::dvec3 e = skin.positions[next] - skin.positions[v];
                const double square = glm::dot(e, e);
                if (!(square > 0.0)) continue;
                _edges.push_back({v, next, share(v) + share(next)});
                const glm::dvec3 middle = skin.positions[v] + 0.5 * e - centre;
                for (const glm::dvec3& turn : turns) {
                    const glm::dvec3 u = glm::cross(turn, middle);
                    _turned.push_back({glm::dot(e, u) / square, glm::dot(u, u) / square});
                }
            }
    }

    const std::vector<std::uint32_t>& freeVertices() const { return _free; }

    double of(const std::vector<double>& field) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < _edges.size(); ++i)
            sum += _edges[i].weight * energy(i, field).value;
        return sum;
    }

    /// Newton's step of the free vertices; empty if the system cannot be solved.
    Eigen::VectorXd step(const std::vector<double>& field) const {
        const auto count = static_cast<Eigen::Index>(_free.size());
        Eigen::VectorXd slopes = Eigen::VectorXd::Zero(count);
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t i = 0; i < _edges.size(); ++i) {
            const TurnedEdge& edge = _edges[i];
            const EdgeEnergy at = energy(i, field);
            const double curvature = edge.weight * at.curvature;
            const int from = _row[edge.from], to = _row[edge.to];
            slopes[from] -= edge.weight * at.slope;
            entries.emplace_back(from, from, curvature);
            if (to < 0) continue;
            slopes[to] += edge.weight * at.slope;
            entries.emplace_back(to, to, curvature);
            entries.emplace_back(from, to, -curvature);
            entries.emplace_back(to, from, -curvature);
        }
        Eigen::SparseMatrix<double> curvatures(count, count);
        curvatures.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(curvatures);
        if (solver.info() != Eigen::Success) return {};
        return solver.solve(-slopes);
    }

private:
    EdgeEnergy energy(std::size_t edge, const std::vector<double>& field) const {
        const double d = field[_edges[edge].to] - field[_edges[edge].from];
        EdgeEnergy sum;
        for (std::size_t i = edge * _turns; i < (edge + 1) * _turns; ++i)
            addEnergy(_turned[i], d, sum);
        return sum;
    }

    std::size_t _turns;
    std::vector<int> _row;            ///< of a vertex, -1 if it is fixed
    std::vector<std::uint32_t> _free; ///< vertices by row
    std::vector<TurnedEdge> _edges;   ///< `from` is free
    std::vector<Turned> _turned;      ///< of each edge, by rotation
};

} // namespace

void pinUnanchoredPatches(const HeatGraph& skin, const std::vector<double>& field,
                          std::vector<bool>& isFree) {
    const std::vector<bool> isBorder = bordersOf(skin);
    std::vector<bool> isSeen(isFree.size());
    std::vector<std::uint32_t> part;
    for (std::uint32_t first = 0; first < isFree.size(); ++first) {
        if (!isFree[first] || isSeen[first]) continue;
        bool low = false, high = false, ends = false;
        part.assign(1, first);
        isSeen[first] = true;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const std::uint32_t v = part[i];
            ends = ends || isBorder[v];
            for (const std::uint32_t next : skin.neighboursOf(v)) {
                if (!isFree[next]) {
                    (field[next] < 0.5 ? low : high) = true;
                } else if (!isSeen[next]) {
                    isSeen[next] = true;
                    part.push_back(next);
                }
            }
        }
        if (low && high && !ends) continue;
        for (const std::uint32_t v : part) isFree[v] = false;
    }
}

void minimizeStretch(const HeatGraph& skin, std::vector<double>& field,
                     const std::vector<bool>& isFree, const glm::dvec3& centre,
                     const std::vector<glm::dvec3>& turns) {
    const Stretch stretch(skin, isFree, centre, turns);
    double now = stretch.of(field);
    for (int i = 0; i < kNewtonSteps && now > 0.0; ++i) {
        Eigen::VectorXd step = stretch.step(field);
        if (step.size() == 0 || !step.allFinite()) return;
        std::vector<double> moved = field;
        double then = now;
        for (int k = 0; k < kHalvings && !(then < now); ++k, step *= 0.5) {
            for (Eigen::Index row = 0; row < step.size(); ++row) {
                const std::uint32_t v = stretch.freeVertices()[static_cast<std::size_t>(row)];
                moved[v] = std::clamp(field[v] + step[row], 0.0, 1.0);
            }
            then = stretch.of(moved);
        }
        if (!(then < now)) return;
        field.swap(moved);
        if (now - then < kMinGain * now) return;
        now = then;
    }
}

} // namespace osgSkin
