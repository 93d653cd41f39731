// SPDX-License-Identifier: MIT
#include "model/SkinPieces.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

namespace osgSkin {
namespace {

/// A piece whose excess is less than this share of the skin's extent is small enough.
constexpr float kFine = 0.006f;
/// Bend and twist, in radians, that pieces are cut for.
constexpr float kUsualBend = 0.5f, kUsualTwist = 0.25f;
/// How many of many vertices are looked at to choose a cut.
constexpr std::size_t kMostTried = 64;
/// How many joints' ratios are looked at to choose a cut, of those that let vertices stray most. A
/// body has fewer.
constexpr std::size_t kMostJoints = 100;
/// What differs by less than this share is worth the same.
constexpr float kSame = 1e-4f;
/// Where pieces are cut: not in the middle, which is where a symmetrical body has vertices.
constexpr float kMiddle = 0.5013f;

class Cutter {
public:
    Cutter(const PieceVertices& vertices, float extent)
        : _vertices(vertices), _fine(kFine * extent) {}

    std::vector<SkinPiece> cut(std::size_t most) const {
        Rows all(_vertices.model.vertexCount());
        for (std::uint32_t row = 0; row < all.size(); ++row) all[row] = row;
        std::vector<SkinPiece> pieces = {pieceOf(std::move(all))};
        while (pieces.size() < most) {
            SkinPiece* worst = &pieces.front();
            for (SkinPiece& piece : pieces)
                if (piece.excess > (1.0f + kSame) * worst->excess) worst = &piece;
            if (worst->excess <= _fine) break;
            std::array<Rows, 2> halves = halve(worst->rows);
            if (halves[0].empty() || halves[1].empty()) {
                worst->excess = 0.0f; // its vertices are all alike
                continue;
            }
            *worst = pieceOf(std::move(halves[0]));
            pieces.push_back(pieceOf(std::move(halves[1])));
        }
        return pieces;
    }

private:
    /// What a vertex has of a joint, and how far it is from the joint's centre and twist axis.
    struct Follower {
        SkinModel::Ratio ratio;
        float fromCentre, fromTwistAxis;
    };

    /// Some of a piece's vertices, and their ratios of the joints that they follow differently.
    struct Sample {
        Rows rows;
        std::vector<PieceRatios> ranges; ///< by joint
        std::vector<Follower> followers; ///< of each row, one for each of `ranges`

        const Follower* of(std::size_t row) const { return followers.data() + row * ranges.size(); }
    };

    SkinPiece pieceOf(Rows rows) const {
        SkinPiece piece;
        std::vector<glm::vec3> points;
        points.reserve(rows.size());
        for (const std::uint32_t row : rows) points.push_back(_vertices.position(row));
        piece.shape = cylinderAround(points);
        const Sample some = sampleOf(rows);
        piece.excess = excessOf(piece.shape, some);
        piece.rows = std::move(rows);
        return piece;
    }

    Sample sampleOf(const Rows& rows) const {
        Sample result;
        result.rows = thinned(rows);
        result.ranges = _vertices.ranges(result.rows);
        dropConstant(result.ranges);
        result.followers.reserve(result.rows.size() * result.ranges.size());
        std::vector<SkinModel::Ratio> ratios(result.ranges.size());
        for (const std::uint32_t row : result.rows) {
            _vertices.ratiosOf(row, result.ranges, ratios.data());
            const glm::vec3& x = _vertices.position(row);
            for (std::size_t i = 0; i < ratios.size(); ++i) {
                const BoundJoint& joint = _vertices.model.joints()[result.ranges[i].joint];
                result.followers.push_back(
                    {ratios[i], fromCentre(joint, x), fromTwistAxis(joint, x)});
            }
        }
        return result;
    }

    static void dropConstant(std::vector<PieceRatios>& ranges) {
        ranges.erase(std::remove_if(ranges.begin(), ranges.end(),
                                    [](const PieceRatios& range) { return range.isConstant(); }),
                     ranges.end());
    }

    /// How far vertices stick out of the skin, and stray, in a piece of this shape.
    float excessOf(const EllipticCylinder& shape, const Sample& some) const {
        float bulge = 0.0f;
        for (const std::uint32_t row : some.rows) {
            const glm::vec3& n = _vertices.normal(row);
            const float out = shape.reach(n) - glm::dot(_vertices.position(row) - shape.centre, n);
            bulge += out * out;
        }
        float excess = std::sqrt(bulge / static_cast<float>(some.rows.size()));
        for (const float stray : straysOf(some)) excess += stray;
        return excess;
    }

    /// How far each joint's ratios let vertices stray in a usual pose.
    std::vector<float> straysOf(const Sample& some) const {
        std::vector<float> bend(some.ranges.size(), 0.0f), twist(some.ranges.size(), 0.0f);
        for (std::size_t row = 0; row < some.rows.size(); ++row) {
            const Follower* of = some.of(row);
            for (std::size_t i = 0; i < some.ranges.size(); ++i) {
                const PieceRatios& range = some.ranges[i];
                bend[i] = std::max(bend[i],
                                   std::abs(of[i].ratio.bend - range.middle()) * of[i].fromCentre);
                twist[i] = std::max(twist[i], std::abs(of[i].ratio.twist - range.middleTwist()) *
                                                  of[i].fromTwistAxis);
            }
        }
        for (std::size_t i = 0; i < some.ranges.size(); ++i)
            bend[i] = kUsualBend * bend[i] + kUsualTwist * twist[i];
        return bend;
    }

    static Rows thinned(const Rows& rows) {
        if (rows.size() <= kMostTried) return rows;
        Rows some;
        const std::size_t step = rows.size() / kMostTried;
        for (std::size_t i = 0; i < rows.size(); i += step) some.push_back(rows[i]);
        return some;
    }

    /// Some rows of a sample, and what these follow differently.
    Sample partOf(const Sample& all, const Rows& rows) const {
        const Rows some = thinned(rows);
        Sample result;
        std::vector<std::size_t> columns;
        for (std::size_t i = 0; i < all.ranges.size(); ++i) {
            PieceRatios range{all.ranges[i].joint};
            for (const std::uint32_t row : some) range.add(all.of(row)[i].ratio);
            if (range.isConstant()) continue;
            result.ranges.push_back(range);
            columns.push_back(i);
        }
        for (const std::uint32_t row : some) {
            result.rows.push_back(all.rows[row]);
            for (const std::size_t i : columns) result.followers.push_back(all.of(row)[i]);
        }
        return result;
    }

    /// x, y, z, then bend ratios, then twist ratios, of a column of ratios each.
    struct Axis {
        std::size_t index, column;
    };

    /// What a joint must let vertices stray for its ratios to be worth a cut.
    float leastStray(std::vector<float> strays) const {
        if (strays.size() <= kMostJoints) return 0.1f * _fine;
        const auto last = strays.begin() + static_cast<std::ptrdiff_t>(kMostJoints);
        std::nth_element(strays.begin(), last, strays.end(), std::greater<>());
        return std::max(0.1f * _fine, *last);
    }

    /// The way to cut the vertices in two that leaves the least excess.
    std::array<Rows, 2> halve(const Rows& rows) const {
        const Sample some = sampleOf(rows);
        const std::vector<float> strays = straysOf(some);
        std::vector<Axis> axes = {{0, 0}, {1, 0}, {2, 0}};
        const float least = leastStray(strays);
        for (std::size_t kind = 3; kind <= 4; ++kind)
            for (std::size_t i = 0; i < strays.size(); ++i)
                if (strays[i] > least) axes.push_back({kind, i});
        float leastExcess = std::numeric_limits<float>::max();
        Axis bestAxis = axes.front();
        float bestPlace = placeOf(some, bestAxis);
        for (const Axis& axis : axes) {
            const float place = placeOf(some, axis);
            std::array<Rows, 2> halves;
            for (std::uint32_t row = 0; row < some.rows.size(); ++row)
                halves[coordinate(some, row, axis) <= place ? 0 : 1].push_back(row);
            if (halves[0].empty() || halves[1].empty()) continue;
            const float a = excessOf(some, halves[0]), b = excessOf(some, halves[1]);
            if (a * a + b * b >= (1.0f - kSame) * leastExcess) continue;
            leastExcess = a * a + b * b;
            bestAxis = axis;
            bestPlace = place;
        }
        std::array<Rows, 2> halves;
        for (const std::uint32_t row : rows)
            halves[coordinateOf(row, some, bestAxis) <= bestPlace ? 0 : 1].push_back(row);
        return halves;
    }

    /// Of a piece made of these rows of a sample.
    float excessOf(const Sample& all, const Rows& rows) const {
        std::vector<glm::vec3> points;
        points.reserve(rows.size());
        for (const std::uint32_t row : rows) points.push_back(_vertices.position(all.rows[row]));
        return excessOf(cylinderAround(points), partOf(all, rows));
    }

    /// Of a row of the sample.
    float coordinate(const Sample& some, std::uint32_t row, const Axis& axis) const {
        if (axis.index < 3) return _vertices.position(some.rows[row])[static_cast<int>(axis.index)];
        const SkinModel::Ratio& ratio = some.of(row)[axis.column].ratio;
        return axis.index == 3 ? ratio.bend : ratio.twist;
    }
    /// Of any row of the skin.
    float coordinateOf(std::uint32_t row, const Sample& some, const Axis& axis) const {
        if (axis.index < 3) return _vertices.position(row)[static_cast<int>(axis.index)];
        float result = 0.0f;
        _vertices.forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
            if (joint == some.ranges[axis.column].joint)
                result = axis.index == 3 ? ratio.bend : ratio.twist;
        });
        return result;
    }
    float placeOf(const Sample& some, const Axis& axis) const {
        float low = coordinate(some, 0, axis), high = low;
        for (std::uint32_t row = 0; row < some.rows.size(); ++row) {
            const float at = coordinate(some, row, axis);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        return low + kMiddle * (high - low);
    }

    const PieceVertices& _vertices;
    float _fine;
};

} // namespace

std::vector<SkinPiece> cutSkin(const PieceVertices& vertices, float extent, std::size_t most) {
    return Cutter(vertices, extent).cut(most);
}

} // namespace osgSkin
