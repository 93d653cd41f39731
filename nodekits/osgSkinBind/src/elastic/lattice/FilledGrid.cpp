// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/FilledGrid.h"

#include <array>
#include <cmath>
#include <limits>

namespace osgSkin::elastic {
namespace {

constexpr std::int32_t kFilled = -2; ///< not yet given to a copy

/// From a cube's centre to its corner, in edges.
constexpr double kHalfDiagonal = 0.8660254037844386;

/// How many samples off a point may look for the nearest filled one.
constexpr int kSearch = 4;

} // namespace

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
    for (int z = 0; z < 2 * _half; ++z)
        for (int y = 0; y < 2 * _half; ++y)
            for (int x = 0; x < 2 * _half; ++x) {
                const Eigen::Vector3i cell(x, y, z);
                if (!inBall(cell)) continue;
                const Point centre = ((cell.cast<double>().array() + 0.5 - _half) * _edge).matrix();
                const bool cut = skin.distance(centre) < kHalfDiagonal * _edge;
                const bool centreInside = !cut && skin.inside(centre);
                for (int k = 0; k < kFine; ++k)
                    for (int j = 0; j < kFine; ++j)
                        for (int i = 0; i < kFine; ++i) {
                            const Eigen::Vector3i fine = kFine * cell + Eigen::Vector3i(i, j, k);
                            const std::size_t at = indexOf(fine);
                            const Point middle = sampleAt(fine);
                            if (cut ? skin.inside(middle) : centreInside) _copyOf[at] = kFilled;
                            _sure[at] =
                                !cut || skin.distance(middle) > kHalfDiagonal * _edge / kFine;
                        }
            }
}

/// Sheets without an inside (clothes, open skins) and parts thinner than a sample get the samples
/// that their vertices lie in.
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
                _copies.push_back({cell - Eigen::Vector3i::Constant(_half)});
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
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = -kSearch; k <= kSearch; ++k)
        for (int j = -kSearch; j <= kSearch; ++j)
            for (int i = -kSearch; i <= kSearch; ++i) {
                const Eigen::Vector3i other = fine + Eigen::Vector3i(i, j, k);
                if (!contains(other)) continue;
                const std::int32_t copy = _copyOf[indexOf(other)];
                const double away = (sampleAt(other) - point).squaredNorm();
                if (copy == kEmpty || away >= nearest) continue;
                nearest = away;
                best = copy;
            }
    return best;
}

} // namespace osgSkin::elastic
