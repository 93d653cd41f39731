// SPDX-License-Identifier: MIT
#include "model/BoundsProxy.h"

#include "model/CorrectiveBlocks.h"
#include "model/PieceVertices.h"
#include "model/SkinBlocks.h"
#include "model/SkinModelAccess.h"
#include "model/SkinPieces.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace osgSkin {
namespace {

/// Of a skin, for each of its pieces: else these would cost more than its vertices.
constexpr std::size_t kLeastVertices = 12;

/// Writes down what the pose does to a piece, and how far its vertices may stray from it.
class PieceTerms {
public:
    /// What the piece has of one joint when it is blended; see BoundsProxy::Share.
    struct Share {
        float weight = 0.0f, bend = 0.0f, twist = 0.0f, square = 0.0f;
    };

    PieceTerms(const PieceVertices& vertices, const SkinPiece& piece)
        : _vertices(vertices), _joints(vertices.model.joints()), _rows(piece.rows),
          _ranges(vertices.ranges(piece.rows)) {
        for (const PieceRatios& range : _ranges)
            _above.push_back(placeOf(_joints[range.joint].parent));
        // The root is followed wholly, always.
        while (_anchor + 1 < _ranges.size() && _ranges[_anchor + 1].isWhole() &&
               _above[_anchor + 1] == _anchor)
            ++_anchor;
        while (_first < _ranges.size() && _ranges[_first].low == 1.0f &&
               _ranges[_first].lowTwist == 1.0f && _first <= _anchor)
            ++_first;
        lookAtVertices();
        for (std::size_t k = _ranges.size(); k-- > _first;) _terms.push_back(termOf(k));
        _shares = shares();
        // These are as many as the piece's vertices times its joints.
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
            // Without its parent, a joint's own map is not what its vertices follow.
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

    /// The place in _ranges of a joint; the number of ranges where it is not there.
    std::size_t placeOf(int joint) const {
        const auto at = std::lower_bound(_ranges.begin(), _ranges.end(), joint,
                                         [](const PieceRatios& range, int wanted) {
                                             return static_cast<int>(range.joint) < wanted;
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
            // They keep distances from their own centres.
            glm::vec3 from = _vertices.position(_rows[i]);
            float far = 0.0f;
            for (std::size_t k = count; k-- > 0;) {
                const glm::vec3 centre(_joints[_ranges[k].joint].centre);
                far += glm::distance(centre, from);
                from = centre;
                _far[i * count + k] = far;
            }
        }
    }

    /// How far vertices stray by the k-th joint of the ranges, and it together with others.
    void addStrays(std::size_t k, const std::vector<float>& ratios, std::vector<Share>& all) const {
        const BoundJoint& joint = _joints[_ranges[k].joint];
        float high = 0.0f, far = 0.0f;
        std::vector<float> pairs(_ranges.size(), 0.0f); // with joints that turn earlier or later
        for (std::size_t row = 0; row < _rows.size(); ++row) {
            const glm::vec3& x = _vertices.position(_rows[row]);
            const SkinModel::Ratio* const own = ratiosOf(row);
            const float* const most = farOf(row);
            const float bend = std::abs(own[k].bend - ratios[k]);
            const float twist = std::abs(own[k].twist - ratios[k]);
            all[k].bend = std::max(all[k].bend, bend * fromCentre(joint, x));
            all[k].twist = std::max(all[k].twist, twist * fromTwistAxis(joint, x));
            high = std::max(high, fromCentre(joint, x));
            far = std::max(far, most[k]);
            if (bend == 0.0f && twist == 0.0f) continue;
            for (std::size_t i = k + 1; i < _ranges.size(); ++i)
                pairs[i] = std::max(pairs[i], std::max(bend, twist) *
                                                  std::max(own[i].bend, own[i].twist) * most[i]);
        }
        all[k].square += 0.5f * ratios[k] * (1.0f - ratios[k]) * far;
        std::vector<bool> isAbove(k, false);
        for (std::size_t i = _above[k]; i < k; i = _above[i]) isAbove[i] = true;
        for (std::size_t i = 1; i < k; ++i)
            pairs[i] = ratios[k] * std::abs(ratios[i] - (isAbove[i] ? 1.0f : 0.0f)) * high;
        for (std::size_t i = 1; i < pairs.size(); ++i) {
            all[i].square += 0.5f * pairs[i];
            all[k].square += 0.5f * pairs[i];
        }
    }

    /// Lessens _far to what moves vertices at all: joints that turn earlier, by the vertex's own
    /// ratios or the piece's, by no more than these allow (a bend is at most pi, a twist 2 pi).
    void limitFar(const std::vector<float>& ratios) {
        for (std::size_t row = 0; row < _rows.size(); ++row) {
            const glm::vec3& x = _vertices.position(_rows[row]);
            const SkinModel::Ratio* const own = ratiosOf(row);
            float* const far = _far.data() + row * _ranges.size();
            float moved = 0.0f;
            for (std::size_t k = _ranges.size(); k-- > 0;) {
                far[k] = std::min(far[k], fromCentre(_joints[_ranges[k].joint], x) + moved);
                const float bend = std::max(own[k].bend, ratios[k]);
                const float twist = std::max(own[k].twist, ratios[k]);
                moved += std::min(2.0f, 3.15f * bend + 6.3f * twist) * far[k];
            }
        }
    }

    const SkinModel::Ratio* ratiosOf(std::size_t row) const {
        return _ratios.data() + row * _ranges.size();
    }
    const float* farOf(std::size_t row) const { return _far.data() + row * _ranges.size(); }

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

    const PieceVertices& _vertices;
    const std::vector<BoundJoint>& _joints;
    const Rows& _rows;
    std::vector<PieceRatios> _ranges;
    std::vector<std::size_t> _above;       ///< by range: the place of the joint's parent
    std::size_t _anchor = 0, _first = 1;   ///< the first one that any vertex does not follow wholly
    std::vector<SkinModel::Ratio> _ratios; ///< by vertex, then by range
    std::vector<float> _far; ///< the same: from a joint's centre, whatever is done before it
    std::vector<BoundsProxy::Term> _terms;
    std::map<std::uint32_t, Share> _shares;
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

/// How far the modes of correctives take the vertices of a piece, by BoundsProxy::weightOf().
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

/// A piece on its way into a block.
struct CutPiece {
    SkinPiece cut;
    PieceTerms terms;
    Reaches reaches;

    CutPiece(const PieceVertices& vertices, SkinPiece&& piece)
        : cut(std::move(piece)), terms(vertices, cut), reaches(reachesOf(vertices, cut.rows)) {}

    /// The joints that it moves with.
    std::set<std::uint32_t> joints() const {
        std::set<std::uint32_t> result;
        for (const auto& [joint, share] : terms.jointShares())
            if (share.weight != 0.0f) result.insert(joint);
        return result;
    }
};

using CutPieces = std::vector<std::unique_ptr<CutPiece>>;

/// Puts pieces into an order in which those of a block move with few joints altogether: what a
/// block takes grows with these. One with many joints begins, those that add the fewest follow.
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

/// Adds `count` pieces, from the proxy's piece `first` on, as a block.
void addBlock(const std::unique_ptr<CutPiece>* pieces, std::size_t count, std::size_t first,
              BoundsProxy& proxy) {
    BoundsProxy::Block block{};
    block.firstPiece = static_cast<std::uint32_t>(first);
    block.pieceCount = static_cast<std::uint32_t>(count);
    std::map<std::uint32_t, BoundsProxy::Share> shares;
    std::map<std::uint32_t, BoundsProxy::Reach> reaches;
    for (std::size_t lane = 0; lane < BoundsProxy::kAtOnce; ++lane) {
        const std::size_t i = lane < count ? lane : 0;
        const BoundsProxy::Piece& piece = proxy.pieces[first + i];
        for (int axis = 0; axis < 3; ++axis) {
            block.centre[axis].lane[lane] = piece.centre[axis];
            for (int side = 0; side < 3; ++side)
                block.axes[side][axis].lane[lane] = piece.axes[side][axis];
        }
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
    const float largest =
        std::max({extent, far.x, far.y, far.z, std::numeric_limits<float>::min()});
    proxy->noTravel = 2e-6f * largest;
    proxy->rounding = 1.5e-5f * largest;
    const PieceVertices vertices(model);
    CutPieces pieces;
    for (SkinPiece& piece : cutSkin(
             vertices, extent, std::min(BoundsProxy::kMost, model.vertexCount() / kLeastVertices)))
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
