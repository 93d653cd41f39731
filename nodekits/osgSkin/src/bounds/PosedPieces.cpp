// SPDX-License-Identifier: MIT
#include "bounds/PosedPieces.h"

#include <algorithm>

namespace osgSkin {
namespace {

constexpr float kRounding = 2e-6f; ///< of a coordinate: several roundings

/// A cylinder on its way into the pose.
struct PosedPiece {
    Four centre, axes[3];

    explicit PosedPiece(const EllipticCylinder& rest) noexcept : centre(four(rest.centre)) {
        for (int i = 0; i < 3; ++i) axes[i] = four(rest.axes[i]);
    }
    void move(const FourMap& map) noexcept {
        centre = map * centre;
        for (Four& axis : axes) axis = map.turn(axis);
    }
    Four half() const noexcept {
        return sqrt(axes[0] * axes[0] + axes[1] * axes[1]) + abs(axes[2]);
    }
};

} // namespace

/// \tparam Plain whether no joint is moved or scaled
template <bool Plain>
PosedPieces::Strays PosedPieces::straysOf(const BoundsProxy::Piece& piece) const noexcept {
    Strays result;
    float before = 0.0f;
    const BoundsProxy::Term* term = _proxy.terms.data() + piece.firstTerm;
    for (const auto* end = term + piece.termCount; term != end; ++term) {
        const JointMotion& motion = _motions[term->joint];
        const float bend = Plain ? motion.bend : motion.growth * motion.bend + motion.scaling;
        const float twist = Plain ? motion.twist : motion.growth * motion.twist;
        float stray = bend * (term->bendReach + term->bendSpread * before) +
                      twist * (term->twistReach + term->twistSpread * before);
        float moved = bend * (term->bendMove + term->mostBend * before) +
                      twist * (term->twistMove + term->mostTwist * before);
        if (Plain) {
            const float most = bend * term->bendSpread + twist * term->twistSpread;
            stray = std::min(stray, term->mostHigh * most);
            moved = std::min(moved, 2.0f * term->mostHigh);
        } else {
            stray += term->bendSpread * motion.travel;
            moved += term->mostBend * motion.travel;
        }
        before += moved;
        if (!term->turns && term->bend == 1.0f) {
            result.anchored += stray;
        } else if (Plain) {
            result.free += stray;
        } else {
            result.free = motion.growth * result.free + stray;
            result.grown *= motion.growth;
        }
    }
    if (!Plain) result.anchored *= _motions[piece.anchor].growthHere;
    return result;
}

void PosedPieces::add(const BoundsProxy::Piece& piece, FourBox& box) noexcept {
    const JointMotion& anchor = _motions[piece.anchor];
    const Strays strays = _motions.isPlain() ? straysOf<true>(piece) : straysOf<false>(piece);
    const float corrected = _corrections ? _corrections->of(piece) : 0.0f;
    PosedPiece posed(piece.rest);
    const BoundsProxy::Term* term = _proxy.terms.data() + piece.firstTerm;
    for (const auto* end = term + piece.termCount; term != end; ++term)
        if (term->turns) posed.move(_motions.partialTurn(*term));
    posed.move(anchor.map);
    const float more = anchor.growthHere * (strays.free + strays.grown * corrected) +
                       strays.anchored + _proxy.rounding;
    const Four half = posed.half() + all(more) + kRounding * abs(posed.centre);
    box.low = min(box.low, posed.centre - half);
    box.high = max(box.high, posed.centre + half);
}

} // namespace osgSkin
