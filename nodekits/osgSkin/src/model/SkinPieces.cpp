// SPDX-License-Identifier: MIT
#include "model/SkinPieces.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// A piece whose excess is less than this share of the skin's extent is small enough.
constexpr float kFine = 0.006f;
/// Bend and twist, in radians, that pieces are cut for.
constexpr float kUsualBend = 0.5f, kUsualTwist = 0.25f;
/// How many of many vertices are looked at to choose a cut.
constexpr std::size_t kMostTried = 64;
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
    SkinPiece pieceOf(Rows rows) const {
        SkinPiece piece;
        std::vector<glm::vec3> points;
        points.reserve(rows.size());
        for (const std::uint32_t row : rows) points.push_back(_vertices.position(row));
        piece.shape = cylinderAround(points);
        const Rows some = sample(rows);
        // How far the piece sticks out of the skin.
        float bulge = 0.0f;
        for (const std::uint32_t row : some) {
            const glm::vec3& n = _vertices.normal(row);
            const float out =
                piece.shape.reach(n) - glm::dot(_vertices.position(row) - piece.shape.centre, n);
            bulge += out * out;
        }
        piece.excess = std::sqrt(bulge / static_cast<float>(some.size()));
        for (const float stray : straysOf(rangesOf(some), some)) piece.excess += stray;
        piece.rows = std::move(rows);
        return piece;
    }

    /// Of the joints that vertices follow differently.
    std::vector<PieceRatios> rangesOf(const Rows& rows) const {
        std::vector<PieceRatios> ranges = _vertices.ranges(rows);
        ranges.erase(std::remove_if(ranges.begin(), ranges.end(),
                                    [](const PieceRatios& range) { return range.isConstant(); }),
                     ranges.end());
        return ranges;
    }

    /// How far each joint's ratios let vertices stray in a usual pose.
    std::vector<float> straysOf(const std::vector<PieceRatios>& ranges, const Rows& rows) const {
        std::vector<float> bend(ranges.size(), 0.0f), twist(ranges.size(), 0.0f);
        std::vector<SkinModel::Ratio> ratios(ranges.size());
        for (const std::uint32_t row : rows) {
            _vertices.ratiosOf(row, ranges, ratios.data());
            const glm::vec3& x = _vertices.position(row);
            for (std::size_t i = 0; i < ranges.size(); ++i) {
                const PieceRatios& range = ranges[i];
                const BoundJoint& joint = _vertices.model.joints()[range.joint];
                bend[i] = std::max(bend[i], std::abs(ratios[i].bend - range.middle()) *
                                                fromCentre(joint, x));
                twist[i] = std::max(twist[i], std::abs(ratios[i].twist - range.middleTwist()) *
                                                  fromTwistAxis(joint, x));
            }
        }
        for (std::size_t i = 0; i < ranges.size(); ++i)
            bend[i] = kUsualBend * bend[i] + kUsualTwist * twist[i];
        return bend;
    }

    static Rows sample(const Rows& rows) {
        if (rows.size() <= kMostTried) return rows;
        Rows some;
        const std::size_t step = rows.size() / kMostTried;
        for (std::size_t i = 0; i < rows.size(); i += step) some.push_back(rows[i]);
        return some;
    }

    /// The way to cut the vertices in two that leaves the least excess.
    std::array<Rows, 2> halve(const Rows& rows) const {
        const Rows some = sample(rows);
        const std::vector<PieceRatios> all = rangesOf(some);
        const std::vector<float> strays = straysOf(all, some);
        std::vector<PieceRatios> ranges;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (strays[i] > 0.1f * _fine) ranges.push_back(all[i]);
        float least = std::numeric_limits<float>::max();
        std::size_t bestAxis = 0;
        float bestPlace = placeOf(some, ranges, 0);
        for (std::size_t axis = 0; axis < 3 + 2 * ranges.size(); ++axis) {
            const float place = placeOf(some, ranges, axis);
            const std::array<Rows, 2> halves = parted(some, ranges, axis, place);
            if (halves[0].empty() || halves[1].empty()) continue;
            const float a = pieceOf(halves[0]).excess, b = pieceOf(halves[1]).excess;
            if (a * a + b * b >= (1.0f - kSame) * least) continue;
            least = a * a + b * b;
            bestAxis = axis;
            bestPlace = place;
        }
        return parted(rows, ranges, bestAxis, bestPlace);
    }

    /// x, y, z, then each joint's bend ratio, then their twist ratios.
    float coordinate(std::uint32_t row, const std::vector<PieceRatios>& ranges,
                     std::size_t axis) const {
        if (axis < 3) return _vertices.position(row)[static_cast<int>(axis)];
        const bool isBend = axis - 3 < ranges.size();
        const std::uint32_t of = ranges[isBend ? axis - 3 : axis - 3 - ranges.size()].joint;
        float result = 0.0f;
        _vertices.forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
            if (joint == of) result = isBend ? ratio.bend : ratio.twist;
        });
        return result;
    }
    float placeOf(const Rows& rows, const std::vector<PieceRatios>& ranges,
                  std::size_t axis) const {
        float low = coordinate(rows[0], ranges, axis), high = low;
        for (const std::uint32_t row : rows) {
            const float at = coordinate(row, ranges, axis);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        return low + kMiddle * (high - low);
    }
    std::array<Rows, 2> parted(const Rows& rows, const std::vector<PieceRatios>& ranges,
                               std::size_t axis, float place) const {
        std::array<Rows, 2> halves;
        for (const std::uint32_t row : rows)
            halves[coordinate(row, ranges, axis) <= place ? 0 : 1].push_back(row);
        return halves;
    }

    const PieceVertices& _vertices;
    float _fine;
};

} // namespace

std::vector<SkinPiece> cutSkin(const PieceVertices& vertices, float extent, std::size_t most) {
    return Cutter(vertices, extent).cut(most);
}

} // namespace osgSkin
