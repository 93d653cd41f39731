// SPDX-License-Identifier: MIT
//
// Included by BoundsKernel.cpp once for each instruction set.
#if defined(OSGSKIN_POSEDPIECES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_POSEDPIECES_INL_H
#undef OSGSKIN_POSEDPIECES_INL_H
#else
#define OSGSKIN_POSEDPIECES_INL_H
#endif

#include <hwy/highway.h>

#include "bounds/BoundsKernel.h"
#include "bounds/JointMotions-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

constexpr float kRounding = 2e-6f; ///< of a coordinate: several roundings

/// A cylinder on its way into the pose.
struct PosedPiece {
    Four centre, axes[3];

    explicit PosedPiece(const BoundsProxy::Piece& rest) noexcept
        : centre(rest.centre), axes{rest.axes[0], rest.axes[1], rest.axes[2]} {}
    void move(const FourMap& map) noexcept {
        centre = map * centre;
        for (Four& axis : axes) axis = map.turn(axis);
    }
    Four half() const noexcept {
        return sqrt(axes[0] * axes[0] + axes[1] * axes[1]) + abs(axes[2]);
    }
};

/// Boxes of single pieces of skin, moved by a pose's joints.
class PosedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions the pose's
    PosedPieces(const BoundsProxy& proxy, const JointMotions& motions) noexcept
        : _proxy(proxy), _motions(motions) {}

    /// The box of a piece that is turned as its vertices are.
    ///
    /// \param piece of the proxy
    /// \param corrected how far correctives take its vertices
    FourBox turned(const BoundsProxy::Piece& piece, float corrected) const noexcept;

private:
    struct Strays {
        float free = 0.0f;     ///< how far vertices stray before the anchor moves them
        float anchored = 0.0f; ///< how much more by what they have less of the anchor
        float grown = 1.0f;    ///< the scale of the first, at least 1
    };
    template <bool Plain>
    Strays straysOf(const BoundsProxy::Piece& piece) const noexcept;

    const BoundsProxy& _proxy;
    const JointMotions& _motions;
};

/// \tparam Plain whether no joint is moved or scaled
template <bool Plain>
HWY_INLINE PosedPieces::Strays
PosedPieces::straysOf(const BoundsProxy::Piece& piece) const noexcept {
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

HWY_INLINE FourBox PosedPieces::turned(const BoundsProxy::Piece& piece,
                                       float corrected) const noexcept {
    const JointMotion& anchor = _motions[piece.anchor];
    const Strays strays = _motions.isPlain() ? straysOf<true>(piece) : straysOf<false>(piece);
    PosedPiece posed(piece);
    const BoundsProxy::Term* term = _proxy.terms.data() + piece.firstTerm;
    for (const auto* end = term + piece.termCount; term != end; ++term)
        if (term->turns) posed.move(_motions.partialTurn(*term));
    posed.move(anchor.map);
    const float more = anchor.growthHere * (strays.free + strays.grown * corrected) +
                       strays.anchored + _proxy.rounding;
    const Four half = posed.half() + all(more) + kRounding * abs(posed.centre);
    return {posed.centre - half, posed.centre + half};
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
