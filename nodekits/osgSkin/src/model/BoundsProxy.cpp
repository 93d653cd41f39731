// SPDX-License-Identifier: MIT
#include "model/BoundsProxy.h"

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

/// A cylinder over an ellipse: centre + x axes[0] + y axes[1] + z axes[2] with x^2 + y^2 <= 1 and
/// |z| <= 1. The axes are perpendicular to each other.
struct EllipticCylinder {
    glm::vec3 centre{0.0f};
    glm::vec3 axes[3] = {glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};

    /// How far it extends from its centre in a direction.
    float reach(const glm::vec3& direction) const {
        const float x = glm::dot(direction, axes[0]), y = glm::dot(direction, axes[1]);
        return std::sqrt(x * x + y * y) + std::abs(glm::dot(direction, axes[2]));
    }
    /// The radius of the sphere about its centre that contains it.
    float radius() const {
        const float wide = std::max(glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]));
        return std::sqrt(wide + glm::dot(axes[2], axes[2]));
    }
};

/// Approximate eigenvectors of a symmetric matrix, by a few sweeps of Jacobi rotations.
glm::mat3 principalAxes(glm::mat3 m) {
    glm::mat3 axes(1.0f);
    for (int sweep = 0; sweep < 4; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                const float angle = 0.5f * std::atan2(2.0f * m[p][q], m[q][q] - m[p][p]);
                glm::mat3 turn(1.0f);
                turn[p][p] = turn[q][q] = std::cos(angle);
                turn[q][p] = std::sin(angle);
                turn[p][q] = -turn[q][p];
                m = glm::transpose(turn) * m * turn;
                axes = axes * turn;
            }
    return axes;
}

glm::mat3 covariance(const std::vector<glm::vec3>& points) {
    glm::vec3 mean(0.0f);
    for (const glm::vec3& p : points) mean += p / static_cast<float>(points.size());
    glm::mat3 sum(0.0f);
    for (const glm::vec3& p : points) sum += glm::outerProduct(p - mean, p - mean);
    return sum;
}

/// The cylinder around points whose straight axis is axes[2].
EllipticCylinder cylinderAlong(const glm::mat3& axes, const std::vector<glm::vec3>& points) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& p : points) {
        low = glm::min(low, p * axes);
        high = glm::max(high, p * axes);
    }
    const glm::vec3 middle = 0.5f * (low + high);
    const glm::vec3 half =
        glm::max(0.5f * (high - low), glm::vec3(std::numeric_limits<float>::min()));
    float wide = 0.0f, tall = 0.0f; // against `half`
    for (const glm::vec3& p : points) {
        const glm::vec3 at = (p * axes - middle) / half;
        wide = std::max(wide, at.x * at.x + at.y * at.y);
        tall = std::max(tall, std::abs(at.z));
    }
    // Slightly larger, to cover rounding.
    wide = 1.00001f * std::sqrt(wide);
    tall *= 1.00001f;
    EllipticCylinder result{
        axes * middle, {wide * half.x * axes[0], wide * half.y * axes[1], tall * half.z * axes[2]}};
    // Products of tiny numbers would be denormal, which is slow.
    const float nothing = 1e-9f * result.radius();
    for (glm::vec3& axis : result.axes)
        for (int i = 0; i < 3; ++i)
            if (std::abs(axis[i]) < nothing) axis[i] = 0.0f;
    return result;
}

/// About its volume; `least` makes flat ones comparable.
float sizeOf(const EllipticCylinder& c, float least) {
    return (glm::length(c.axes[0]) + least) * (glm::length(c.axes[1]) + least) *
           (1.2732f * glm::length(c.axes[2]) + least);
}

/// A cylinder along the points' principal axes that contains them; not much larger than the
/// smallest.
///
/// \param points at least one
EllipticCylinder cylinderAround(const std::vector<glm::vec3>& points) {
    const glm::mat3 axes = principalAxes(covariance(points));
    EllipticCylinder best = cylinderAlong(axes, points);
    const float least = 0.1f * best.radius();
    for (int turn = 1; turn < 3; ++turn) {
        const EllipticCylinder other =
            cylinderAlong({axes[turn % 3], axes[(turn + 1) % 3], axes[(turn + 2) % 3]}, points);
        // By a margin, so that the choice does not depend on how sums are rounded.
        if (sizeOf(other, least) < 0.9999f * sizeOf(best, least)) best = other;
    }
    return best;
}

/// Vertices, as indices in the model's order.
using Rows = std::vector<std::uint32_t>;

/// The ranges of the ratios that the vertices of a piece have for a joint.
struct PieceRatios {
    std::uint32_t joint;
    float low = 1.0f, high = 0.0f;           ///< bend ratio
    float lowTwist = 1.0f, highTwist = 0.0f; ///< twist ratio

    void add(const SkinModel::Ratio& ratio) {
        low = std::min(low, ratio.bend);
        high = std::max(high, ratio.bend);
        lowTwist = std::min(lowTwist, ratio.twist);
        highTwist = std::max(highTwist, ratio.twist);
    }
    /// Ratios this close to 0 or 1 count as 0 or 1.
    static constexpr float kSnapped = 0.15f;
    static constexpr float kNear = 0.03f; ///< the same for blended pieces

    bool isWhole() const { return low >= 1.0f - kSnapped && lowTwist >= 1.0f - kSnapped; }
    bool isNothing() const { return high <= kSnapped && highTwist <= kSnapped; }
    bool isConstant() const { return low == high && lowTwist == highTwist; }
    /// One ratio for bend and twist. It is the bend's: bends move vertices further, and where a
    /// twist builds up along a bone nothing bends.
    float snapped() const {
        const float ratio = middle();
        return ratio < kNear ? 0.0f : ratio > 1.0f - kNear ? 1.0f : ratio;
    }
    float middle() const { return 0.5f * (low + high); }
    float middleTwist() const { return 0.5f * (lowTwist + highTwist); }
};

/// A model's vertices in the order of its groups: row i is vertex order()[i].
class PieceVertices {
public:
    explicit PieceVertices(const SkinModel& of)
        : model(of), _places(productPlaces(productOrder(of.joints()))) {
        for (std::uint32_t g = 0; g < model.groups().size(); ++g)
            _group.insert(_group.end(), model.groups()[g].vertexCount, g);
    }
    /// A joint's position in productOrder().
    std::uint32_t place(std::uint32_t joint) const { return _places[joint]; }

    const glm::vec3& position(std::uint32_t row) const {
        return model.positions()[model.order()[row]];
    }
    const glm::vec3& normal(std::uint32_t row) const { return model.normals()[model.order()[row]]; }
    std::uint32_t group(std::uint32_t row) const { return _group[row]; }
    std::uint32_t rowInGroup(std::uint32_t row) const {
        return row - model.groups()[_group[row]].firstVertex;
    }

    /// Calls `each(joint, ratio)` for each joint that a vertex follows, in productOrder().
    template <typename Each>
    void forEachJoint(std::uint32_t row, Each&& each) const {
        const SkinModel::Group& group = model.groups()[_group[row]];
        const SkinModel::Ratio* partial = model.ratios().data() + group.firstRatio +
                                          std::size_t(rowInGroup(row)) * group.partialCount;
        for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
            const SkinModel::Link& link = model.links()[i];
            const SkinModel::Ratio ratio = link.partial ? *partial++ : SkinModel::Ratio{1.0f, 1.0f};
            if (ratio.bend != 0.0f || ratio.twist != 0.0f) each(link.joint, ratio);
        }
    }

    /// The ratios that a vertex has for `joints`, which are in productOrder().
    void ratiosOf(std::uint32_t row, const std::vector<PieceRatios>& joints,
                  SkinModel::Ratio* result) const {
        std::fill(result, result + joints.size(), SkinModel::Ratio{0.0f, 0.0f});
        std::size_t at = 0;
        forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
            while (at < joints.size() && place(joints[at].joint) < place(joint)) ++at;
            if (at < joints.size() && joints[at].joint == joint) result[at] = ratio;
        });
    }

    /// The joints that any of the vertices follows, in productOrder().
    /// \param rows of the vertices
    std::vector<PieceRatios> ranges(const Rows& rows) const {
        std::vector<PieceRatios> result;
        std::vector<std::uint32_t> followers;
        for (const std::uint32_t row : rows) {
            std::size_t at = 0;
            forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
                while (at < result.size() && place(result[at].joint) < place(joint)) ++at;
                if (at == result.size() || result[at].joint != joint) {
                    result.insert(result.begin() + static_cast<std::ptrdiff_t>(at),
                                  PieceRatios{joint});
                    followers.insert(followers.begin() + static_cast<std::ptrdiff_t>(at), 0u);
                }
                result[at].add(ratio);
                ++followers[at];
            });
        }
        for (std::size_t i = 0; i < result.size(); ++i)
            if (followers[i] < rows.size()) result[i].add({0.0f, 0.0f});
        return result;
    }

    const SkinModel& model;

private:
    std::vector<std::uint32_t> _places; ///< of each joint
    std::vector<std::uint32_t> _group;  ///< of each row
};

inline float fromTwistAxis(const BoundJoint& joint, const glm::vec3& point) {
    const glm::vec3 from = point - glm::vec3(joint.centre);
    return glm::length(glm::cross(from, glm::vec3(joint.twistAxis)));
}
inline float fromCentre(const BoundJoint& joint, const glm::vec3& point) {
    return glm::distance(glm::vec3(joint.centre), point);
}

/// The vertices of one piece of a BoundsProxy.
struct SkinPiece {
    Rows rows;
    EllipticCylinder shape;
    float excess = 0.0f; ///< by how much it enlarges the bounds in a typical pose
};

/// Pieces whose excess is below this fraction of the skin's extent are not cut further.
constexpr float kFine = 0.006f;
/// The bend and twist of a typical pose, radians.
constexpr float kUsualBend = 0.5f, kUsualTwist = 0.25f;
/// The most vertices sampled to choose a cut.
constexpr std::size_t kMaxTried = 64;
/// The most joints considered for a cut, those whose vertices deviate most. A body has fewer.
constexpr std::size_t kMaxJoints = 100;
/// Relative differences below this are ignored.
constexpr float kSame = 1e-4f;
/// Where pieces are cut: off the middle, where a symmetrical body has vertices.
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
                worst->excess = 0.0f; // all its vertices are alike
                continue;
            }
            *worst = pieceOf(std::move(halves[0]));
            pieces.push_back(pieceOf(std::move(halves[1])));
        }
        return pieces;
    }

private:
    /// A vertex's ratios for a joint, and its distances from the joint's centre and twist axis.
    struct Follower {
        SkinModel::Ratio ratio;
        float fromCentre, fromTwistAxis;
    };

    /// Some of a piece's vertices, and their ratios for the joints for which these differ.
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

    /// How far the shape extends beyond the skin, and its vertices deviate in a typical pose.
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

    /// For each joint, how far its ratios let vertices deviate in a typical pose.
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
        if (rows.size() <= kMaxTried) return rows;
        Rows some;
        const std::size_t step = rows.size() / kMaxTried;
        for (std::size_t i = 0; i < rows.size(); i += step) some.push_back(rows[i]);
        return some;
    }

    /// The sample of some rows of a sample.
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

    /// 0 to 2: x, y, z; 3 and 4: the bend and twist ratios of a column.
    struct Axis {
        std::size_t index, column;
    };

    /// The least deviation for which a joint's ratios are tried as a cut.
    float leastStray(std::vector<float> strays) const {
        if (strays.size() <= kMaxJoints) return 0.1f * _fine;
        const auto last = strays.begin() + static_cast<std::ptrdiff_t>(kMaxJoints);
        std::nth_element(strays.begin(), last, strays.end(), std::greater<>());
        return std::max(0.1f * _fine, *last);
    }

    /// The best cut in two.
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

    /// \param rows of the sample
    float excessOf(const Sample& all, const Rows& rows) const {
        std::vector<glm::vec3> points;
        points.reserve(rows.size());
        for (const std::uint32_t row : rows) points.push_back(_vertices.position(all.rows[row]));
        return excessOf(cylinderAround(points), partOf(all, rows));
    }

    /// \param row of the sample
    float coordinate(const Sample& some, std::uint32_t row, const Axis& axis) const {
        if (axis.index < 3) return _vertices.position(some.rows[row])[static_cast<int>(axis.index)];
        const SkinModel::Ratio& ratio = some.of(row)[axis.column].ratio;
        return axis.index == 3 ? ratio.bend : ratio.twist;
    }
    /// \param row of the skin
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

/// Cuts a skin into pieces whose vertices deviate little from the pieces' fixed ratios. Of several
/// cuts that are about equally good, as on a symmetrical body, it takes the first, so that the
/// result does not depend on how sums are rounded.
///
/// \param vertices at least one
/// \param extent of the skin
/// \param most pieces
std::vector<SkinPiece> cutSkin(const PieceVertices& vertices, float extent, std::size_t most) {
    return Cutter(vertices, extent).cut(most);
}

/// Finds the terms of a piece, and how far its vertices may deviate from it.
class PieceTerms {
public:
    /// Of one joint; see BoundsProxy::Share.
    struct Share {
        float weight = 0.0f, bend = 0.0f, twist = 0.0f, square = 0.0f;
    };

    /// Both must outlive this.
    PieceTerms(const PieceVertices& vertices, const SkinPiece& piece)
        : _vertices(vertices), _joints(vertices.model.joints()), _rows(piece.rows),
          _ranges(vertices.ranges(piece.rows)) {
        for (const PieceRatios& range : _ranges)
            _above.push_back(placeOf(_joints[range.joint].parent));
        // All vertices follow the root fully.
        while (_anchor + 1 < _ranges.size() && _ranges[_anchor + 1].isWhole() &&
               _above[_anchor + 1] == _anchor)
            ++_anchor;
        while (_first < _ranges.size() && _ranges[_first].low == 1.0f &&
               _ranges[_first].lowTwist == 1.0f && _first <= _anchor)
            ++_first;
        lookAtVertices();
        for (std::size_t k = _ranges.size(); k-- > _first;) _terms.push_back(termOf(k));
        _shares = shares();
        // Frees the large tables.
        _ratios = {};
        _far = {};
    }

    void addTo(BoundsProxy& proxy, BoundsProxy::Piece& piece) const {
        piece.anchor = _ranges[_anchor].joint;
        piece.firstTerm = static_cast<std::uint32_t>(proxy.terms.size());
        piece.termCount = static_cast<decltype(piece.termCount)>(_terms.size());
        proxy.terms.insert(proxy.terms.end(), _terms.begin(), _terms.end());
    }

    const std::map<std::uint32_t, Share>& jointShares() const { return _shares; }

private:
    std::map<std::uint32_t, Share> shares() {
        std::vector<float> ratios(_ranges.size(), 1.0f);
        std::vector<Share> all(_ranges.size());
        all[0].weight = 1.0f;
        for (std::size_t k = 1; k < _ranges.size(); ++k) {
            // A joint counts only where its parent does.
            const std::size_t parent = _above[k];
            ratios[k] = parent < k && ratios[parent] > 0.0f ? _ranges[k].snapped() : 0.0f;
            if (ratios[k] > 0.0f) all[parent].weight -= ratios[k];
            all[k].weight += ratios[k];
        }
        limitFar(ratios);
        for (std::size_t k = 1; k < _ranges.size(); ++k) addStrays(k, ratios, all);
        std::map<std::uint32_t, Share> result;
        for (std::size_t k = 0; k < all.size(); ++k)
            if (all[k].weight != 0.0f || all[k].bend > 0.0f || all[k].twist > 0.0f ||
                all[k].square > 0.0f)
                result[_ranges[k].joint] = all[k];
        return result;
    }
    /// A joint's index in _ranges; their number where it is not among them.
    std::size_t placeOf(int joint) const {
        if (joint < 0) return _ranges.size();
        const std::uint32_t place = _vertices.place(static_cast<std::uint32_t>(joint));
        const auto at = std::lower_bound(_ranges.begin(), _ranges.end(), place,
                                         [this](const PieceRatios& range, std::uint32_t wanted) {
                                             return _vertices.place(range.joint) < wanted;
                                         });
        return at != _ranges.end() && static_cast<int>(at->joint) == joint
                   ? static_cast<std::size_t>(at - _ranges.begin())
                   : _ranges.size();
    }
    void lookAtVertices() {
        const std::size_t count = _ranges.size();
        _ratios.resize(_rows.size() * count);
        _far.resize(_rows.size() * count);
        for (std::size_t i = 0; i < _rows.size(); ++i) {
            _vertices.ratiosOf(_rows[i], _ranges, _ratios.data() + i * count);
            // Rotations keep the distances between neighbouring centres.
            glm::vec3 from = _vertices.position(_rows[i]);
            float reach = 0.0f;
            for (std::size_t k = count; k-- > 0;) {
                const glm::vec3 centre(_joints[_ranges[k].joint].centre);
                reach += glm::distance(centre, from);
                from = centre;
                _far[i * count + k] = reach;
            }
        }
    }
    /// Adds how far vertices deviate by the k-th joint, alone and with others.
    void addStrays(std::size_t k, const std::vector<float>& ratios, std::vector<Share>& all) const {
        const BoundJoint& joint = _joints[_ranges[k].joint];
        float high = 0.0f, reach = 0.0f;
        std::vector<float> pairs(_ranges.size(), 0.0f); // with other joints
        for (std::size_t row = 0; row < _rows.size(); ++row) {
            const glm::vec3& x = _vertices.position(_rows[row]);
            const SkinModel::Ratio* const own = ratiosOf(row);
            const float* const most = farOf(row);
            const float bend = std::abs(own[k].bend - ratios[k]);
            const float twist = std::abs(own[k].twist - ratios[k]);
            all[k].bend = std::max(all[k].bend, bend * fromCentre(joint, x));
            all[k].twist = std::max(all[k].twist, twist * fromTwistAxis(joint, x));
            high = std::max(high, fromCentre(joint, x));
            reach = std::max(reach, most[k]);
            if (bend == 0.0f && twist == 0.0f) continue;
            for (std::size_t i = k + 1; i < _ranges.size(); ++i)
                pairs[i] = std::max(pairs[i], std::max(bend, twist) *
                                                  std::max(own[i].bend, own[i].twist) * most[i]);
        }
        all[k].square += 0.5f * ratios[k] * (1.0f - ratios[k]) * reach;
        std::vector<bool> isAbove(k, false);
        for (std::size_t i = _above[k]; i < k; i = _above[i]) isAbove[i] = true;
        for (std::size_t i = 1; i < k; ++i)
            pairs[i] = ratios[k] * std::abs(ratios[i] - (isAbove[i] ? 1.0f : 0.0f)) * high;
        for (std::size_t i = 1; i < pairs.size(); ++i) {
            all[i].square += 0.5f * pairs[i];
            all[k].square += 0.5f * pairs[i];
        }
    }
    /// Limits _far by how far the joints applied before can move a vertex by its own ratios or
    /// the piece's (a bend is at most pi, a twist 2 pi).
    void limitFar(const std::vector<float>& ratios) {
        for (std::size_t row = 0; row < _rows.size(); ++row) {
            const glm::vec3& x = _vertices.position(_rows[row]);
            const SkinModel::Ratio* const own = ratiosOf(row);
            float* const reach = _far.data() + row * _ranges.size();
            float moved = 0.0f;
            for (std::size_t k = _ranges.size(); k-- > 0;) {
                reach[k] = std::min(reach[k], fromCentre(_joints[_ranges[k].joint], x) + moved);
                const float bend = std::max(own[k].bend, ratios[k]);
                const float twist = std::max(own[k].twist, ratios[k]);
                moved += std::min(2.0f, 3.15f * bend + 6.3f * twist) * reach[k];
            }
        }
    }
    BoundsProxy::Term termOf(std::size_t k) const {
        const PieceRatios& range = _ranges[k];
        const BoundJoint& joint = _joints[range.joint];
        const bool anchored = k <= _anchor;
        BoundsProxy::Term term{};
        term.joint = range.joint;
        term.turns = !anchored && !range.isNothing();
        term.bend = anchored ? 1.0f : term.turns ? range.middle() : 0.0f;
        term.twist = anchored ? 1.0f : term.turns ? range.middleTwist() : 0.0f;
        term.bendSpread = std::max(range.high - term.bend, term.bend - range.low);
        term.twistSpread = std::max(range.highTwist - term.twist, term.twist - range.lowTwist);
        term.mostBend = range.high;
        term.mostTwist = range.highTwist;
        for (std::size_t row = 0; row < _rows.size(); ++row) {
            const glm::vec3& x = _vertices.position(_rows[row]);
            const SkinModel::Ratio& ratio = ratiosOf(row)[k];
            const float high = fromCentre(joint, x), wide = fromTwistAxis(joint, x);
            term.bendReach = std::max(term.bendReach, std::abs(ratio.bend - term.bend) * high);
            term.twistReach = std::max(term.twistReach, std::abs(ratio.twist - term.twist) * wide);
            term.bendMove = std::max(term.bendMove, ratio.bend * high);
            term.twistMove = std::max(term.twistMove, ratio.twist * wide);
            term.mostHigh = std::max(term.mostHigh, farOf(row)[k]);
        }
        return term;
    }
    const SkinModel::Ratio* ratiosOf(std::size_t row) const {
        return _ratios.data() + row * _ranges.size();
    }
    const float* farOf(std::size_t row) const { return _far.data() + row * _ranges.size(); }

    const PieceVertices& _vertices;
    const std::vector<BoundJoint>& _joints;
    const Rows& _rows;
    std::vector<PieceRatios> _ranges;
    std::vector<std::size_t> _above;       ///< by range: the place of the joint's parent
    std::size_t _anchor = 0, _first = 1;   ///< `_first`: not followed fully by all vertices
    std::vector<SkinModel::Ratio> _ratios; ///< by vertex, then by range
    std::vector<float> _far; ///< the same: from a joint's centre, whatever is done before it
    std::vector<BoundsProxy::Term> _terms;
    std::map<std::uint32_t, Share> _shares;
};

/// The fewest vertices of a skin for each piece: else pieces would cost more than vertices.
constexpr std::size_t kMinVertices = 12;

/// The length of a mode's share in a lane.
float lengthOf(const CorrectiveRow* block, std::size_t mode, std::size_t lane) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float share = block[3 * mode + axis].lane[lane];
        sum += share * share;
    }
    return std::sqrt(sum);
}

/// How far corrective modes move the vertices of a piece, by BoundsProxy::weightOf().
using Reaches = std::map<std::uint32_t, float>;

Reaches reachesOf(const PieceVertices& vertices, const Rows& rows) {
    Reaches result;
    const CorrectiveBlocks* blocks = SkinModelAccess::correctives(vertices.model);
    if (!blocks) return result;
    for (const std::uint32_t row : rows) {
        const std::uint32_t group = vertices.group(row), inGroup = vertices.rowInGroup(row);
        for (std::uint32_t i = blocks->firstRange[group]; i < blocks->firstRange[group + 1]; ++i) {
            const CorrectiveBlocks::Range& range = blocks->ranges[i];
            const CorrectiveRow* block = blocks->blockOf(range, inGroup);
            if (!block) continue;
            for (std::size_t k = 0; k < blocks->joints[range.joint].modes; ++k) {
                const float length = lengthOf(block, k, inGroup % kBlock);
                if (length == 0.0f) continue;
                float& most = result[BoundsProxy::weightOf(range.joint, k)];
                most = std::max(most, length);
            }
        }
    }
    return result;
}

/// A piece before it is put into a block.
struct CutPiece {
    SkinPiece cut;
    PieceTerms terms;
    Reaches reaches;

    CutPiece(const PieceVertices& vertices, SkinPiece&& piece)
        : cut(std::move(piece)), terms(vertices, cut), reaches(reachesOf(vertices, cut.rows)) {}

    /// The joints that move it.
    std::set<std::uint32_t> joints() const {
        std::set<std::uint32_t> result;
        for (const auto& [joint, share] : terms.jointShares())
            if (share.weight != 0.0f) result.insert(joint);
        return result;
    }
};

using CutPieces = std::vector<std::unique_ptr<CutPiece>>;

/// Orders pieces so that each block depends on few joints, which its cost grows with: a block
/// starts with a piece of many joints, then takes those that add the fewest.
void orderByJoints(CutPieces& pieces) {
    std::vector<std::set<std::uint32_t>> joints;
    for (const std::unique_ptr<CutPiece>& piece : pieces) joints.push_back(piece->joints());
    std::set<std::uint32_t> block;
    const auto added = [&](const std::set<std::uint32_t>& by) {
        return std::count_if(by.begin(), by.end(), [&](auto j) { return block.count(j) == 0; });
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i % BoundsProxy::kAtOnce == 0) block.clear();
        std::size_t next = i;
        for (std::size_t k = i + 1; k < pieces.size(); ++k) {
            const auto more = block.empty() ? 0 : added(joints[k]) - added(joints[next]);
            if (more < 0 || (more == 0 && joints[k].size() > joints[next].size())) next = k;
        }
        std::swap(pieces[i], pieces[next]);
        std::swap(joints[i], joints[next]);
        block.insert(joints[i].begin(), joints[i].end());
    }
}

/// Copies the cylinders of a block's pieces to its lanes.
void setShapes(const BoundsProxy& proxy, BoundsProxy::Block& block) {
    for (std::size_t lane = 0; lane < BoundsProxy::kAtOnce; ++lane) {
        const std::size_t i = lane < block.pieceCount ? lane : 0;
        const BoundsProxy::Piece& piece = proxy.pieces[block.firstPiece + i];
        for (int axis = 0; axis < 3; ++axis) {
            block.centre[axis].lane[lane] = piece.centre[axis];
            for (int side = 0; side < 3; ++side)
                block.axes[side][axis].lane[lane] = piece.axes[side][axis];
        }
    }
}

/// Adds pieces `first` to `first + count` of the proxy as a block.
void addBlock(const std::unique_ptr<CutPiece>* pieces, std::size_t count, std::size_t first,
              BoundsProxy& proxy) {
    BoundsProxy::Block block{};
    block.firstPiece = static_cast<std::uint32_t>(first);
    block.pieceCount = static_cast<std::uint32_t>(count);
    setShapes(proxy, block);
    std::map<std::uint32_t, BoundsProxy::Share> shares;
    std::map<std::uint32_t, BoundsProxy::Reach> reaches;
    for (std::size_t lane = 0; lane < BoundsProxy::kAtOnce; ++lane) {
        const std::size_t i = lane < count ? lane : 0;
        for (const auto& [weight, length] : pieces[i]->reaches) {
            BoundsProxy::Reach& reach = reaches[weight];
            reach.weight = weight;
            reach.length.lane[lane] = length;
        }
        for (const auto& [joint, of] : pieces[i]->terms.jointShares()) {
            BoundsProxy::Share& share = shares[joint];
            share.joint = joint;
            share.weight.lane[lane] = of.weight;
            share.bend.lane[lane] = of.bend;
            share.twist.lane[lane] = of.twist;
            share.square.lane[lane] = of.square;
        }
    }
    block.firstShare = static_cast<std::uint32_t>(proxy.shares.size());
    for (const bool weighted : {true, false}) {
        for (const auto& [joint, share] : shares) {
            const float* weights = share.weight.lane;
            const bool any = std::any_of(weights, weights + BoundsProxy::kAtOnce,
                                         [](float weight) { return weight != 0.0f; });
            if (any == weighted) proxy.shares.push_back(share);
        }
        const auto now = static_cast<std::uint32_t>(proxy.shares.size()) - block.firstShare;
        (weighted ? block.weighted : block.shareCount) = now;
    }
    block.firstReach = static_cast<std::uint32_t>(proxy.reaches.size());
    block.reachCount = static_cast<std::uint32_t>(reaches.size());
    for (const auto& [weight, reach] : reaches) proxy.reaches.push_back(reach);
    proxy.blocks.push_back(block);
}

void addJoints(const SkinModel& model, BoundsProxy& proxy) {
    for (const BoundJoint& joint : model.joints()) {
        const glm::dmat3 frame = jointFrame(joint);
        proxy.joints.push_back({four(glm::vec3(joint.centre)), four(glm::vec3(frame[2])),
                                four(glm::vec3(frame[0])), four(glm::vec3(frame[1])), joint.parent,
                                false});
    }
    for (const BoundsProxy::Piece& piece : proxy.pieces) proxy.joints[piece.anchor].isNeeded = true;
    for (const BoundsProxy::Term& term : proxy.terms) proxy.joints[term.joint].isNeeded = true;
    for (const BoundsProxy::Share& share : proxy.shares) proxy.joints[share.joint].isNeeded = true;
    for (std::size_t j = proxy.joints.size(); j-- > 0;)
        if (proxy.joints[j].isNeeded && proxy.joints[j].parent >= 0)
            proxy.joints[static_cast<std::size_t>(proxy.joints[j].parent)].isNeeded = true;
}

} // namespace

void completeBoundsProxy(const SkinModel& model, BoundsProxy& proxy) {
    const auto check = [](bool fits) {
        if (!fits) throw Error("skin model: its bounds do not fit it");
    };
    const auto checkLanes = [&](const BoundsProxy::Lanes& lanes) {
        for (const float lane : lanes.lane) check(std::isfinite(lane));
    };
    const auto checkVector = [&](const Four& vector) {
        for (int axis = 0; axis < 3; ++axis) check(std::isfinite(vector[axis]));
    };
    const std::size_t joints = model.joints().size();
    const CorrectiveBlocks* const correctives = SkinModelAccess::correctives(model);
    check(!proxy.blocks.empty() && proxy.pieces.size() <= BoundsProxy::kMost &&
          std::isfinite(proxy.noTravel) && std::isfinite(proxy.rounding));
    std::size_t terms = 0, pieces = 0, shares = 0, reaches = 0;
    for (BoundsProxy::Piece& piece : proxy.pieces) {
        check(piece.anchor < joints && piece.termCount <= proxy.terms.size() - terms);
        piece.firstTerm = static_cast<std::uint32_t>(terms);
        terms += piece.termCount;
        checkVector(piece.centre);
        for (const Four& axis : piece.axes) checkVector(axis);
    }
    for (const BoundsProxy::Term& term : proxy.terms) {
        check(term.joint < joints);
        for (const float number : {term.bend, term.twist, term.bendSpread, term.twistSpread,
                                   term.mostBend, term.mostTwist, term.bendReach, term.twistReach,
                                   term.bendMove, term.twistMove, term.mostHigh})
            check(std::isfinite(number));
    }
    for (BoundsProxy::Block& block : proxy.blocks) {
        check(block.pieceCount >= 1 && block.pieceCount <= BoundsProxy::kAtOnce &&
              block.pieceCount <= proxy.pieces.size() - pieces &&
              block.shareCount <= proxy.shares.size() - shares &&
              block.weighted <= block.shareCount &&
              block.reachCount <= proxy.reaches.size() - reaches);
        block.firstPiece = static_cast<std::uint32_t>(pieces);
        block.firstShare = static_cast<std::uint32_t>(shares);
        block.firstReach = static_cast<std::uint32_t>(reaches);
        pieces += block.pieceCount;
        shares += block.shareCount;
        reaches += block.reachCount;
        setShapes(proxy, block);
    }
    check(terms == proxy.terms.size() && pieces == proxy.pieces.size() &&
          shares == proxy.shares.size() && reaches == proxy.reaches.size());
    for (const BoundsProxy::Share& share : proxy.shares) {
        check(share.joint < joints);
        for (const auto* lanes : {&share.weight, &share.bend, &share.twist, &share.square})
            checkLanes(*lanes);
    }
    for (const BoundsProxy::Reach& reach : proxy.reaches) {
        const std::size_t joint = reach.weight / CorrectiveJoint::kMaxModes;
        check(correctives && joint < correctives->joints.size() &&
              reach.weight % CorrectiveJoint::kMaxModes < correctives->joints[joint].modes);
        checkLanes(reach.length);
    }
    addJoints(model, proxy);
}

std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model) {
    if (model.vertexCount() == 0) return nullptr;
    glm::vec3 low = model.positions().front(), high = low;
    for (const glm::vec3& p : model.positions()) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low, outermost = glm::max(glm::abs(low), glm::abs(high));
    const float extent = std::max({size.x, size.y, size.z});
    const std::shared_ptr<BoundsProxy> proxy = std::make_shared<BoundsProxy>();
    const float largest = std::max(
        {extent, outermost.x, outermost.y, outermost.z, std::numeric_limits<float>::min()});
    proxy->noTravel = 2e-6f * largest;
    proxy->rounding = 1.5e-5f * largest;
    const PieceVertices vertices(model);
    CutPieces pieces;
    for (SkinPiece& piece : cutSkin(
             vertices, extent, std::min(BoundsProxy::kMost, model.vertexCount() / kMinVertices)))
        pieces.push_back(std::make_unique<CutPiece>(vertices, std::move(piece)));
    orderByJoints(pieces);
    for (const std::unique_ptr<CutPiece>& from : pieces) {
        BoundsProxy::Piece piece{};
        piece.centre = four(from->cut.shape.centre);
        for (int side = 0; side < 3; ++side) piece.axes[side] = four(from->cut.shape.axes[side]);
        from->terms.addTo(*proxy, piece);
        proxy->pieces.push_back(piece);
    }
    for (std::size_t first = 0; first < pieces.size(); first += BoundsProxy::kAtOnce)
        addBlock(&pieces[first], std::min(BoundsProxy::kAtOnce, pieces.size() - first), first,
                 *proxy);
    addJoints(model, *proxy);
    return proxy;
}

} // namespace osgSkin
