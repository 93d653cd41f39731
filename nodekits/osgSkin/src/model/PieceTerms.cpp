// SPDX-License-Identifier: MIT
#include "model/PieceTerms.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {

PieceTerms::PieceTerms(const PieceVertices& vertices, const SkinPiece& piece)
    : _vertices(vertices), _joints(vertices.model.joints()), _rows(piece.rows),
      _ranges(vertices.ranges(piece.rows)) {
    for (const PieceRatios& range : _ranges) _above.push_back(placeOf(_joints[range.joint].parent));
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

void PieceTerms::addTo(BoundsProxy& proxy, BoundsProxy::Piece& piece) const {
    piece.anchor = _ranges[_anchor].joint;
    piece.firstTerm = static_cast<std::uint32_t>(proxy.terms.size());
    piece.termCount = static_cast<decltype(piece.termCount)>(_terms.size());
    proxy.terms.insert(proxy.terms.end(), _terms.begin(), _terms.end());
}

std::map<std::uint32_t, PieceTerms::Share> PieceTerms::shares() {
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
std::size_t PieceTerms::placeOf(int joint) const {
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

void PieceTerms::lookAtVertices() {
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
void PieceTerms::addStrays(std::size_t k, const std::vector<float>& ratios,
                           std::vector<Share>& all) const {
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
void PieceTerms::limitFar(const std::vector<float>& ratios) {
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

BoundsProxy::Term PieceTerms::termOf(std::size_t k) const {
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

} // namespace osgSkin
