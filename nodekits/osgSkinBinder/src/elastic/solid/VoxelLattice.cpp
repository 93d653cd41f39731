// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/VoxelLattice.h"

#include "mesh/DisjointSets.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

namespace osgSkin::elastic {
namespace {

bool bit(std::size_t number, Eigen::Index axis) {
    return (number >> axis & 1u) != 0;
}

constexpr std::int32_t kFilled = -2; ///< not yet assigned to a copy

/// Distance from a cube's centre to its corners, in edges.
constexpr double kHalfDiagonal = 0.8660254037844386;

/// How far from a point the nearest filled sample may be, in samples.
constexpr int kSearch = 4;

Point cornerOf(const Point& low, double edge, std::size_t corner) {
    return low + edge * Point(double(corner & 1u), double(corner >> 1 & 1u), double(corner >> 2));
}

} // namespace

Point CellShape::local(std::size_t point) {
    Point result;
    for (Eigen::Index axis = 0; axis < 3; ++axis) result[axis] = bit(point, axis) ? kHigh : kLow;
    return result;
}

std::array<double, CellShape::kCorners> CellShape::values(const Point& local) {
    std::array<double, kCorners> result{};
    for (std::size_t c = 0; c < kCorners; ++c) {
        result[c] = 1.0;
        for (Eigen::Index axis = 0; axis < 3; ++axis)
            result[c] *= bit(c, axis) ? local[axis] : 1.0 - local[axis];
    }
    return result;
}

Eigen::Matrix<double, 3, 8> CellShape::slopes(const Point& local) {
    Eigen::Matrix<double, 3, 8> result;
    for (std::size_t c = 0; c < kCorners; ++c)
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            double slope = bit(c, axis) ? 1.0 : -1.0;
            for (Eigen::Index other = 0; other < 3; ++other)
                if (other != axis) slope *= bit(c, other) ? local[other] : 1.0 - local[other];
            result(axis, static_cast<Eigen::Index>(c)) = slope;
        }
    return result;
}

CellShape::CellShape(double length) : edge(length) {
    for (std::size_t g = 0; g < kPoints; ++g) {
        const auto shares = values(local(g));
        const Eigen::Matrix<double, 3, 8> slopesHere = slopes(local(g)) / edge;
        for (std::size_t c = 0; c < kCorners; ++c) {
            value[c][g] = shares[c];
            for (Eigen::Index axis = 0; axis < 3; ++axis)
                slope[axis][c][g] = slopesHere(axis, static_cast<Eigen::Index>(c));
        }
    }
}

Eigen::Matrix<double, 8, 8> CellShape::laplacian() const {
    Eigen::Matrix<double, 8, 8> result = Eigen::Matrix<double, 8, 8>::Zero();
    for (std::size_t a = 0; a < kCorners; ++a)
        for (std::size_t b = 0; b < kCorners; ++b)
            for (const auto& along : slope)
                for (std::size_t g = 0; g < kPoints; ++g)
                    result(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) +=
                        volumeOfPoint() * along[a][g] * along[b][g];
    return result;
}

FilledGrid::FilledGrid(const RestSkin& skin, double edge, double reach)
    : _edge(edge), _reach(reach), _half(static_cast<int>(std::ceil(reach / edge))),
      _samples(2 * _half * kFine),
      _copyOf(static_cast<std::size_t>(_samples) * static_cast<std::size_t>(_samples) *
                  static_cast<std::size_t>(_samples),
              kEmpty),
      _sure(_copyOf.size(), false) {
    classify(skin);
    fillAroundVertices(skin);
    makeCopies();
}

Point FilledGrid::sampleAt(const Eigen::Vector3i& fine) const {
    return ((fine.cast<double>().array() + 0.5) / kFine - _half).matrix() * _edge;
}

Eigen::Vector3i FilledGrid::fineAt(const Point& point) const {
    return ((point.array() / _edge + _half) * kFine).floor().cast<int>();
}

bool FilledGrid::contains(const Eigen::Vector3i& fine) const {
    return fine.minCoeff() >= 0 && fine.maxCoeff() < _samples;
}

bool FilledGrid::inBall(const Eigen::Vector3i& cell) const {
    return ((cell.cast<double>().array() + 0.5 - _half) * _edge).matrix().norm() < _reach;
}

void FilledGrid::classify(const RestSkin& skin) {
    const double cellRoom = kHalfDiagonal * _edge, sampleRoom = cellRoom / kFine;
    for (int z = 0; z < 2 * _half; ++z)
        for (int y = 0; y < 2 * _half; ++y) {
            double room = 0.0; // at most the distance from a cell's centre to the skin
            for (int x = 0; x < 2 * _half; ++x) {
                const Eigen::Vector3i cell(x, y, z), low = kFine * cell;
                room -= _edge;
                if (!inBall(cell)) continue;
                if (room < cellRoom)
                    room = skin.distance(
                        ((cell.cast<double>().array() + 0.5 - _half) * _edge).matrix());
                const bool cut = room < cellRoom;
                _sure[indexOf(low)] = !cut;
                const bool lowInside = !cut && isInside(skin, low);
                for (int k = 0; k < kFine; ++k)
                    for (int j = 0; j < kFine; ++j)
                        for (int i = 0; i < kFine; ++i) {
                            const Eigen::Vector3i fine = low + Eigen::Vector3i(i, j, k);
                            const std::size_t at = indexOf(fine);
                            _sure[at] = !cut || skin.distance(sampleAt(fine)) > sampleRoom;
                            if (cut ? isInside(skin, fine) : lowInside) _copyOf[at] = kFilled;
                        }
            }
        }
}

/// If nothing of a closed skin is between a sample and the one before it along an axis, both are on
/// the same side.
bool FilledGrid::isInside(const RestSkin& skin, const Eigen::Vector3i& fine) const {
    if (skin.isClosed() && _sure[indexOf(fine)])
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i before = fine - Eigen::Vector3i::Unit(axis);
            if (before[axis] >= 0 && _sure[indexOf(before)])
                return _copyOf[indexOf(before)] == kFilled;
        }
    return skin.inside(sampleAt(fine));
}

/// Fills the samples around vertices of sheets without an inside (clothes, open skins) and of parts
/// thinner than a sample.
void FilledGrid::fillAroundVertices(const RestSkin& skin) {
    for (Eigen::Index v = 0; v < skin.positions().cols(); ++v) {
        const Eigen::Vector3i fine = fineAt(skin.positions().col(v));
        if (!contains(fine) || !inBall(fine / kFine)) continue;
        _sure[indexOf(fine)] = false;
        bool near = false;
        for (int k = -1; k <= 1; ++k)
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const Eigen::Vector3i other = fine + Eigen::Vector3i(i, j, k);
                    near = near || (contains(other) && _copyOf[indexOf(other)] == kFilled);
                }
        if (!near) _copyOf[indexOf(fine)] = kFilled;
    }
}

void FilledGrid::makeCopies() {
    for (int z = 0; z < _samples; ++z)
        for (int y = 0; y < _samples; ++y)
            for (int x = 0; x < _samples; ++x) {
                if (_copyOf[indexOf({x, y, z})] != kFilled) continue;
                const Eigen::Vector3i from(x, y, z), cell = from / kFine;
                _copies.emplace_back(cell - Eigen::Vector3i::Constant(_half));
                flood(from, cell, static_cast<std::int32_t>(_copies.size()) - 1);
            }
}

void FilledGrid::flood(const Eigen::Vector3i& from, const Eigen::Vector3i& cell,
                       std::int32_t copy) {
    std::vector<Eigen::Vector3i> front{from};
    _copyOf[indexOf(from)] = copy;
    for (std::size_t done = 0; done < front.size(); ++done)
        for (int axis = 0; axis < 3; ++axis)
            for (const int way : {-1, 1}) {
                const Eigen::Vector3i next = front[done] + way * Eigen::Vector3i::Unit(axis);
                if (!contains(next) || next / kFine != cell) continue;
                std::int32_t& owner = _copyOf[indexOf(next)];
                if (owner != kFilled) continue;
                owner = copy;
                front.push_back(next);
            }
}

std::int32_t FilledGrid::copyAt(const Point& point) const {
    const Eigen::Vector3i fine = fineAt(point);
    return contains(fine) ? _copyOf[indexOf(fine)] : kEmpty;
}

std::optional<bool> FilledGrid::isInside(const Point& point) const {
    const Eigen::Vector3i fine = fineAt(point);
    if (!contains(fine) || !_sure[indexOf(fine)]) return std::nullopt;
    return _copyOf[indexOf(fine)] != kEmpty;
}

std::int32_t FilledGrid::copyNear(const Point& point) const {
    if (const std::int32_t here = copyAt(point); here != kEmpty) return here;
    const Eigen::Vector3i fine = fineAt(point);
    std::int32_t best = kEmpty;
    for (const int search : {1, kSearch}) { // most are found among the first
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = -search; k <= search; ++k)
            for (int j = -search; j <= search; ++j)
                for (int i = -search; i <= search; ++i) {
                    const Eigen::Vector3i other = fine + Eigen::Vector3i(i, j, k);
                    if (!contains(other)) continue;
                    const std::int32_t copy = _copyOf[indexOf(other)];
                    if (copy == kEmpty) continue;
                    const double away = (sampleAt(other) - point).norm();
                    if (away >= nearest) continue;
                    nearest = away;
                    best = copy;
                }
        if (nearest * kFine < (search + 0.5) * _edge) return best;
    }
    return best;
}

template <typename Join>
void FilledGrid::forEachTouch(const Join& join) const {
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
        for (int z = 0; z < _samples; ++z)
            for (int y = 0; y < _samples; ++y)
                for (int x = 0; x < _samples; ++x) {
                    const Eigen::Vector3i here(x, y, z), next = here + step;
                    if (here[axis] % kFine != kFine - 1 || !contains(next)) continue;
                    const std::int32_t a = _copyOf[indexOf(here)];
                    const std::int32_t b = _copyOf[indexOf(next)];
                    if (a != kEmpty && b != kEmpty) join(a, b, axis);
                }
    }
}

VoxelLattice::VoxelLattice(const RestSkin& skin, double edge, double reach)
    : _grid(skin, edge, reach), _shape(edge) {
    connect();
}

/// Joins copies that touch: they share the nodes of the face between them.
void VoxelLattice::connect() {
    const std::size_t copies = _grid.copies().size();
    DisjointSets pieces(copies), corners(8 * copies);
    _grid.forEachTouch([&](std::int32_t a, std::int32_t b, int axis) {
        const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
        const std::size_t step = std::size_t(1) << axis;
        pieces.join(from, to);
        for (std::size_t c = 0; c < 8; ++c)
            if ((c & step) == 0) corners.join(8 * from + (c | step), 8 * to + c);
    });
    const std::int32_t middle = [&] { // the copy whose centre is nearest to the joint's
        std::int32_t best = FilledGrid::kEmpty;
        double nearest = _grid.reach();
        for (std::size_t i = 0; i < copies; ++i) {
            const double away =
                ((_grid.copies()[i].cast<double>().array() + 0.5) * _grid.edge()).matrix().norm();
            if (away >= nearest) continue;
            nearest = away;
            best = static_cast<std::int32_t>(i);
        }
        return best;
    }();
    if (middle == FilledGrid::kEmpty) throw Unsolvable("there is no skin around the joint");

    _cellOfCopy.assign(copies, -1);
    std::vector<std::size_t> sets;
    const std::size_t main = pieces.find(static_cast<std::size_t>(middle));
    for (std::size_t i = 0; i < copies; ++i) {
        if (pieces.find(i) != main) continue;
        _cellOfCopy[i] = static_cast<std::int32_t>(_cells.size());
        Cell& cell = _cells.emplace_back();
        cell.low = _grid.copies()[i].cast<double>() * _grid.edge();
        for (std::size_t c = 0; c < 8; ++c) sets.push_back(corners.find(8 * i + c));
    }
    numberNodes(sets);
}

/// \param setOf for each corner of each cell any number that identifies its node
void VoxelLattice::numberNodes(const std::vector<std::size_t>& setOf) {
    std::map<std::size_t, std::uint32_t> numbers;
    std::vector<Point> free, pinned;
    const double rim = _grid.reach() - _grid.edge();
    for (const bool pin : {false, true})
        for (std::size_t i = 0; i < setOf.size(); ++i) {
            Cell& cell = _cells[i / 8];
            const Point at = cornerOf(cell.low, _grid.edge(), i % 8);
            if ((at.norm() > rim) != pin) continue;
            const auto count = static_cast<std::uint32_t>(free.size() + pinned.size());
            const auto [place, added] = numbers.try_emplace(setOf[i], count);
            if (added) (pin ? pinned : free).push_back(at);
            cell.nodes[i % 8] = place->second;
        }
    _free = static_cast<Eigen::Index>(free.size());
    if (free.empty() || pinned.empty()) throw Unsolvable("its limbs end within reach");
    free.insert(free.end(), pinned.begin(), pinned.end());
    _rest.resize(3, static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) _rest.col(static_cast<Eigen::Index>(i)) = free[i];
}

Point VoxelLattice::gaussPoint(const Cell& cell, std::size_t point) const {
    return cell.low + _shape.edge * CellShape::local(point);
}

bool VoxelLattice::embed(const Point& rest, Embedded& result) const {
    const std::int32_t copy = _grid.copyNear(rest);
    if (copy == FilledGrid::kEmpty || _cellOfCopy[static_cast<std::size_t>(copy)] < 0) return false;
    result.cell = static_cast<std::uint32_t>(_cellOfCopy[static_cast<std::size_t>(copy)]);
    const Point local = (rest - _cells[result.cell].low) / _shape.edge;
    const Point within = local.cwiseMax(0.0).cwiseMin(1.0);
    const Point beyond = local - within;
    result.weights = CellShape::values(within);
    const Eigen::Matrix<double, 3, 8> slopes = CellShape::slopes(within);
    for (std::size_t c = 0; c < 8; ++c)
        result.weights[c] += slopes.col(static_cast<Eigen::Index>(c)).dot(beyond);
    return true;
}

Point VoxelLattice::positionOf(const Embedded& point, const Points& nodes) const {
    Point result = Point::Zero();
    const Cell& cell = _cells[point.cell];
    for (std::size_t c = 0; c < 8; ++c) result += point.weights[c] * nodes.col(cell.nodes[c]);
    return result;
}

} // namespace osgSkin::elastic
