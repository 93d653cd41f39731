// SPDX-License-Identifier: MIT
#include "model/BoundsProxy.h"

#include "model/CorrectiveBlocks.h"
#include "model/SkinModelAccess.h"

#include <glm/common.hpp>
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
/// Ratios this near to 0 or 1 do not turn a piece.
constexpr float kSnapped = 0.15f;

using Rows = std::vector<std::uint32_t>;

/// What vertices of one piece have of one joint.
struct Range {
    std::uint32_t joint;
    float low = 1.0f, high = 0.0f;           ///< bend ratio
    float lowTwist = 1.0f, highTwist = 0.0f; ///< twist ratio

    void add(const SkinModel::Ratio& ratio) {
        low = std::min(low, ratio.bend);
        high = std::max(high, ratio.bend);
        lowTwist = std::min(lowTwist, ratio.twist);
        highTwist = std::max(highTwist, ratio.twist);
    }
    bool isWhole() const { return low >= 1.0f - kSnapped && lowTwist >= 1.0f - kSnapped; }
    bool isMost() const { return low + high >= 1.0f && lowTwist + highTwist >= 1.0f; }
    bool isNothing() const { return high <= kSnapped && highTwist <= kSnapped; }
    bool isConstant() const { return low == high && lowTwist == highTwist; }
    float middle() const { return 0.5f * (low + high); }
    float middleTwist() const { return 0.5f * (lowTwist + highTwist); }
};

/// A model's vertices in the order of its groups: row i is vertex order()[i].
class Vertices {
public:
    explicit Vertices(const SkinModel& of) : model(of) {
        for (std::uint32_t g = 0; g < model.groups().size(); ++g)
            _group.insert(_group.end(), model.groups()[g].vertexCount, g);
    }
    const glm::vec3& position(std::uint32_t row) const {
        return model.positions()[model.order()[row]];
    }
    const glm::vec3& normal(std::uint32_t row) const { return model.normals()[model.order()[row]]; }
    std::uint32_t group(std::uint32_t row) const { return _group[row]; }
    std::uint32_t rowInGroup(std::uint32_t row) const {
        return row - model.groups()[_group[row]].firstVertex;
    }

    /// Calls `each(joint, ratio)` for the joints that a vertex follows, in their order.
    template <typename Each>
    void forEachJoint(std::uint32_t row, Each&& each) const {
        const SkinModel::Group& group = model.groups()[_group[row]];
        const SkinModel::Ratio* partial = model.ratios().data() + group.firstRatio +
                                          std::size_t(rowInGroup(row)) * group.partialCount;
        for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
            const SkinModel::Link& link = model.links()[i];
            each(link.joint, link.partial ? *partial++ : SkinModel::Ratio{1.0f, 1.0f});
        }
    }

    /// What a vertex has of a joint.
    SkinModel::Ratio ratioOf(std::uint32_t row, std::uint32_t joint) const {
        SkinModel::Ratio result{0.0f, 0.0f};
        forEachJoint(row, [&](std::uint32_t other, const SkinModel::Ratio& ratio) {
            if (other == joint) result = ratio;
        });
        return result;
    }

    /// The joints that any of the vertices follows, in their order.
    std::vector<Range> ranges(const Rows& rows) const {
        std::vector<Range> result;
        std::vector<std::uint32_t> followers;
        for (const std::uint32_t row : rows) {
            std::size_t at = 0;
            forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
                while (at < result.size() && result[at].joint < joint) ++at;
                if (at == result.size() || result[at].joint != joint) {
                    result.insert(result.begin() + static_cast<std::ptrdiff_t>(at), Range{joint});
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
    std::vector<std::uint32_t> _group; ///< of each row
};

float fromTwistAxis(const BoundJoint& joint, const glm::vec3& point) {
    const glm::vec3 from = point - glm::vec3(joint.centre);
    return glm::length(glm::cross(from, glm::vec3(joint.twistAxis)));
}
float fromCentre(const BoundJoint& joint, const glm::vec3& point) {
    return glm::distance(glm::vec3(joint.centre), point);
}

/// Vertices that may become one piece.
struct Cell {
    Rows rows;
    EllipticCylinder shape;
    float excess = 0.0f; ///< by how much bounds are larger for its sake in a usual pose
};

class Cutter {
public:
    Cutter(const Vertices& vertices, float extent) : _vertices(vertices), _fine(kFine * extent) {}

    std::vector<Cell> cut() const {
        Rows all(_vertices.model.vertexCount());
        for (std::uint32_t row = 0; row < all.size(); ++row) all[row] = row;
        std::vector<Cell> cells = {cellOf(std::move(all))};
        const std::size_t pieces = SkinModelAccess::correctives(_vertices.model)
                                       ? BoundsProxy::kMostCorrected
                                       : BoundsProxy::kMost;
        const std::size_t most = std::min(pieces, _vertices.model.vertexCount() / 12);
        while (cells.size() < most) {
            const auto worst =
                std::max_element(cells.begin(), cells.end(),
                                 [](const Cell& a, const Cell& b) { return a.excess < b.excess; });
            if (worst->excess <= _fine) break;
            std::array<Rows, 2> halves = halve(worst->rows);
            if (halves[0].empty() || halves[1].empty()) {
                worst->excess = 0.0f; // its vertices are all alike
                continue;
            }
            *worst = cellOf(std::move(halves[0]));
            cells.push_back(cellOf(std::move(halves[1])));
        }
        return cells;
    }

private:
    Cell cellOf(Rows rows) const {
        Cell cell;
        std::vector<glm::vec3> points;
        points.reserve(rows.size());
        for (const std::uint32_t row : rows) points.push_back(_vertices.position(row));
        cell.shape = cylinderAround(points);
        const Rows some = sample(rows);
        // How far the piece sticks out of the skin.
        float bulge = 0.0f;
        for (const std::uint32_t row : some) {
            const glm::vec3& n = _vertices.normal(row);
            const float out =
                cell.shape.reach(n) - glm::dot(_vertices.position(row) - cell.shape.centre, n);
            bulge += out * out;
        }
        cell.excess = std::sqrt(bulge / static_cast<float>(some.size()));
        for (const Range& range : _vertices.ranges(some))
            if (!range.isConstant()) cell.excess += strayOf(range, some);
        cell.rows = std::move(rows);
        return cell;
    }

    /// How far a joint's ratios let vertices stray in a usual pose.
    float strayOf(const Range& range, const Rows& rows) const {
        const BoundJoint& joint = _vertices.model.joints()[range.joint];
        float bend = 0.0f, twist = 0.0f;
        for (const std::uint32_t row : rows) {
            const SkinModel::Ratio ratio = _vertices.ratioOf(row, range.joint);
            const glm::vec3& x = _vertices.position(row);
            bend = std::max(bend, std::abs(ratio.bend - range.middle()) * fromCentre(joint, x));
            twist = std::max(twist,
                             std::abs(ratio.twist - range.middleTwist()) * fromTwistAxis(joint, x));
        }
        return kUsualBend * bend + kUsualTwist * twist;
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
        std::vector<Range> ranges;
        for (const Range& range : _vertices.ranges(some))
            if (strayOf(range, some) > 0.1f * _fine) ranges.push_back(range);
        float least = std::numeric_limits<float>::max();
        std::size_t bestAxis = 0;
        float bestMiddle = middleOf(some, ranges, 0);
        for (std::size_t axis = 0; axis < 3 + 2 * ranges.size(); ++axis) {
            const float middle = middleOf(some, ranges, axis);
            const std::array<Rows, 2> halves = parted(some, ranges, axis, middle);
            if (halves[0].empty() || halves[1].empty()) continue;
            const float a = cellOf(halves[0]).excess, b = cellOf(halves[1]).excess;
            if (a * a + b * b >= least) continue;
            least = a * a + b * b;
            bestAxis = axis;
            bestMiddle = middle;
        }
        return parted(rows, ranges, bestAxis, bestMiddle);
    }

    /// x, y, z, then each joint's bend ratio, then their twist ratios.
    float coordinate(std::uint32_t row, const std::vector<Range>& ranges, std::size_t axis) const {
        if (axis < 3) return _vertices.position(row)[static_cast<int>(axis)];
        const bool isBend = axis - 3 < ranges.size();
        const std::uint32_t of = ranges[isBend ? axis - 3 : axis - 3 - ranges.size()].joint;
        float result = 0.0f;
        _vertices.forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
            if (joint == of) result = isBend ? ratio.bend : ratio.twist;
        });
        return result;
    }
    float middleOf(const Rows& rows, const std::vector<Range>& ranges, std::size_t axis) const {
        float low = coordinate(rows[0], ranges, axis), high = low;
        for (const std::uint32_t row : rows) {
            const float at = coordinate(row, ranges, axis);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        return 0.5f * (low + high);
    }
    std::array<Rows, 2> parted(const Rows& rows, const std::vector<Range>& ranges, std::size_t axis,
                               float middle) const {
        std::array<Rows, 2> halves;
        for (const std::uint32_t row : rows)
            halves[coordinate(row, ranges, axis) <= middle ? 0 : 1].push_back(row);
        return halves;
    }

    const Vertices& _vertices;
    float _fine;
};

/// Writes down what the pose does to a piece, and how far its vertices may stray from it.
class PieceTerms {
public:
    PieceTerms(const Vertices& vertices, const Cell& cell)
        : _vertices(vertices), _joints(vertices.model.joints()), _rows(cell.rows),
          _ranges(vertices.ranges(cell.rows)) {}

    /// \return whether any term turns the piece
    bool addTo(BoundsProxy& proxy, BoundsProxy::Piece& piece) const {
        // The root is followed wholly, always.
        std::size_t anchor = 0, first = 1; // the first one that any vertex does not follow wholly
        while (anchor + 1 < _ranges.size() && _ranges[anchor + 1].isWhole() &&
               isBelow(anchor + 1, anchor))
            ++anchor;
        while (first < _ranges.size() && _ranges[first].low == 1.0f &&
               _ranges[first].lowTwist == 1.0f && first <= anchor)
            ++first;
        piece.anchor = _ranges[anchor].joint;
        std::size_t home = anchor;
        while (home + 1 < _ranges.size() && _ranges[home + 1].isMost() && isBelow(home + 1, home))
            ++home;
        piece.home = _ranges[home].joint;
        piece.firstTerm = static_cast<std::uint32_t>(proxy.terms.size());
        bool turns = false;
        for (std::size_t k = _ranges.size(); k-- > first;) {
            const BoundsProxy::Term term = termOf(k, k <= anchor, k <= home);
            turns = turns || term.turns;
            proxy.terms.push_back(term);
            ++piece.termCount;
        }
        return turns;
    }

private:
    bool isBelow(std::size_t range, std::size_t above) const {
        return _joints[_ranges[range].joint].parent == static_cast<int>(_ranges[above].joint);
    }

    BoundsProxy::Term termOf(std::size_t k, bool anchored, bool atHome) const {
        const Range& range = _ranges[k];
        const BoundJoint& joint = _joints[range.joint];
        BoundsProxy::Term term{};
        term.joint = range.joint;
        term.turns = !anchored && !range.isNothing();
        term.bend = anchored ? 1.0f : term.turns ? range.middle() : 0.0f;
        term.twist = anchored ? 1.0f : term.turns ? range.middleTwist() : 0.0f;
        term.bendSpread = std::max(range.high - term.bend, term.bend - range.low);
        term.twistSpread = std::max(range.highTwist - term.twist, term.twist - range.lowTwist);
        const float home = atHome ? 1.0f : 0.0f;
        term.homeBendSpread = std::max(range.high - home, home - range.low);
        term.homeTwistSpread = std::max(range.highTwist - home, home - range.lowTwist);
        term.mostBend = range.high;
        term.mostTwist = range.highTwist;
        for (const std::uint32_t row : _rows) {
            const glm::vec3& x = _vertices.position(row);
            const SkinModel::Ratio ratio = _vertices.ratioOf(row, range.joint);
            const float high = fromCentre(joint, x), wide = fromTwistAxis(joint, x);
            term.bendReach = std::max(term.bendReach, std::abs(ratio.bend - term.bend) * high);
            term.twistReach = std::max(term.twistReach, std::abs(ratio.twist - term.twist) * wide);
            term.homeBendReach = std::max(term.homeBendReach, std::abs(ratio.bend - home) * high);
            term.homeTwistReach =
                std::max(term.homeTwistReach, std::abs(ratio.twist - home) * wide);
            term.bendMove = std::max(term.bendMove, ratio.bend * high);
            term.twistMove = std::max(term.twistMove, ratio.twist * wide);
            // Joints that turn earlier keep distances from their own centres.
            float far = 0.0f;
            glm::vec3 from = x;
            for (std::size_t i = _ranges.size(); i-- > k;) {
                const glm::vec3 centre(_joints[_ranges[i].joint].centre);
                far += glm::distance(centre, from);
                from = centre;
            }
            term.mostHigh = std::max(term.mostHigh, far);
        }
        return term;
    }

    const Vertices& _vertices;
    const std::vector<BoundJoint>& _joints;
    const Rows& _rows;
    std::vector<Range> _ranges;
};

/// Length of the k-th mode's shares in a lane.
float lengthOf(const CorrectiveRow* block, std::size_t mode, std::size_t lane) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float share = block[3 * mode + axis].lane[lane];
        sum += share * share;
    }
    return std::sqrt(sum);
}

/// What |beta_k| of a joint cannot exceed: its coordinates are clamped, splines add up to 1.
float mostOf(const CorrectiveJoint& joint, std::size_t mode) {
    using Basis = CorrectiveJoint::Basis;
    const std::size_t functions = joint.functionCount();
    const double* c = joint.coefficients.data() + mode * functions;
    const double x = std::max(std::abs(joint.low.x), std::abs(joint.high.x));
    if (joint.basis == Basis::Input) return static_cast<float>(std::abs(c[0]) * x);
    const double y = std::max(std::abs(joint.low.y), std::abs(joint.high.y));
    double most = 0.0;
    if (joint.basis == Basis::Ball) {
        const double all[] = {x,         y,         x * x,     x * y,    y * y,
                              x * x * x, x * x * y, x * y * y, y * y * y};
        for (std::size_t i = 0; i < functions; ++i) most += std::abs(c[i]) * all[i];
        return static_cast<float>(most);
    }
    const bool hinge = joint.basis == Basis::Hinge;
    const std::size_t splines = hinge ? functions - 3 : functions / 7;
    const double r = std::sqrt(x * x + y * y);
    double low = c[0], high = c[0], powers = 0.0;
    for (std::size_t i = 0; i < splines; ++i) {
        const double* of = hinge ? c + i : c + 7 * i;
        low = std::min(low, of[0]);
        high = std::max(high, of[0]);
        if (hinge) continue;
        powers = std::max(powers, (std::abs(of[1]) + std::abs(of[2])) * r +
                                      (std::abs(of[3]) + std::abs(of[4])) * r * r +
                                      (std::abs(of[5]) + std::abs(of[6])) * r * r * r);
    }
    if (hinge)
        powers = std::abs(c[splines]) * y + std::abs(c[splines + 1]) * x * y +
                 std::abs(c[splines + 2]) * y * y;
    return static_cast<float>(high - low + powers);
}

/// Adds how far correctives can take the vertices of a piece.
void addCorrections(const Vertices& vertices, const Rows& rows, BoundsProxy& proxy,
                    BoundsProxy::Piece& piece) {
    const CorrectiveBlocks* blocks = SkinModelAccess::correctives(vertices.model);
    if (!blocks) return;
    std::vector<std::vector<float>> reach(blocks->joints.size());
    for (const std::uint32_t row : rows) {
        const std::uint32_t group = vertices.group(row), inGroup = vertices.rowInGroup(row);
        for (std::uint32_t i = blocks->firstRange[group]; i < blocks->firstRange[group + 1]; ++i) {
            const CorrectiveBlocks::Range& range = blocks->ranges[i];
            const CorrectiveRow* block = blocks->blockOf(range, inGroup);
            if (!block) continue;
            std::vector<float>& of = reach[range.joint];
            of.resize(blocks->joints[range.joint].modes, 0.0f);
            for (std::size_t k = 0; k < of.size(); ++k)
                of[k] = std::max(of[k], lengthOf(block, k, inGroup % kBlock));
        }
    }
    piece.firstCorrection = static_cast<std::uint32_t>(proxy.corrections.size());
    for (std::uint32_t joint = 0; joint < reach.size(); ++joint) {
        const std::vector<float>& of = reach[joint];
        if (std::all_of(of.begin(), of.end(), [](float length) { return length == 0.0f; }))
            continue;
        proxy.corrections.push_back({joint, static_cast<std::uint32_t>(proxy.reach.size())});
        proxy.reach.insert(proxy.reach.end(), of.begin(), of.end());
        ++piece.correctionCount;
        for (std::size_t k = 0; k < of.size(); ++k)
            piece.corrected += 1.0001f * mostOf(blocks->joints[joint], k) * of[k] /
                               static_cast<float>(Correctives::kUnit);
    }
}

} // namespace

std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model) {
    if (model.vertexCount() == 0) return nullptr;
    glm::vec3 low = model.positions().front(), high = low;
    for (const glm::vec3& p : model.positions()) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low, far = glm::max(glm::abs(low), glm::abs(high));
    const float extent = std::max({size.x, size.y, size.z});
    const std::shared_ptr<BoundsProxy> proxy = std::make_shared<BoundsProxy>();
    proxy->rounding =
        2e-6f * std::max({extent, far.x, far.y, far.z, std::numeric_limits<float>::min()});
    const Vertices vertices(model);
    std::vector<BoundsProxy::Piece> turned;
    for (const Cell& cell : Cutter(vertices, extent).cut()) {
        BoundsProxy::Piece piece{};
        piece.rest = cell.shape;
        piece.radius = cell.shape.radius();
        const bool turns = PieceTerms(vertices, cell).addTo(*proxy, piece);
        addCorrections(vertices, cell.rows, *proxy, piece);
        (turns || piece.correctionCount > 0 ? turned : proxy->pieces).push_back(piece);
    }
    proxy->pieces.insert(proxy->pieces.end(), turned.begin(), turned.end());
    return proxy;
}

} // namespace osgSkin
