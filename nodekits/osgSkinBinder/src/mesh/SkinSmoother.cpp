// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SkinSmoother.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <queue>

namespace osgSkin {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Edges longer than this many times the mean do not join vertices to a group.
constexpr double kLongest = 2.0;

/// Relaxation factor of Jacobi's method.
constexpr double kRelaxation = 2.0 / 3.0;

/// Jacobi steps after interpolation. Each leaves about a tenth of the groups' outlines visible.
constexpr int kRounding = 3;

template <typename Element>
void sortUnique(std::vector<Element>& elements) {
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
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
    sortUnique(reached);
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

/// The same skin with about a seventh of the vertices, for fields much wider than its edges.
///
/// Each group of fine vertices, a vertex and its neighbours, becomes one coarse vertex at their
/// centroid. Three groups that meet in a triangle give a coarse triangle. Edges longer than twice
/// the mean do not join a group, so sparse skin stays as it is.
class CoarseGraph {
public:
    /// \param fine must outlive this
    explicit CoarseGraph(const HeatGraph& fine);

    const HeatGraph& graph() const { return _graph; }

    /// A field on the fine skin, averaged over each group.
    std::vector<double> restricted(const std::vector<double>& field) const;
    /// A field on the coarse skin, interpolated; constant if the coarse one is.
    std::vector<double> interpolated(const std::vector<double>& field) const;

private:
    void makeGroups();
    void connectGroups();

    const HeatGraph& _fine;
    HeatGraph _graph;
    std::vector<std::uint32_t> _groupOf; ///< coarse vertex of each fine one
};

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
    for (const auto& t : _fine.triangles) {
        std::array<std::uint32_t, 3> corners = {_groupOf[t[0]], _groupOf[t[1]], _groupOf[t[2]]};
        std::sort(corners.begin(), corners.end());
        if (corners[0] != corners[1] && corners[1] != corners[2])
            _graph.triangles.push_back(corners);
    }
    sortUnique(_graph.triangles);

    std::vector<DirectedEdge> edges; // in both directions
    for (std::uint32_t v = 0; v < _fine.vertexCount(); ++v)
        for (const std::uint32_t next : _fine.neighboursOf(v))
            if (_groupOf[v] != _groupOf[next]) edges.emplace_back(_groupOf[v], _groupOf[next]);
    sortUnique(edges);
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
