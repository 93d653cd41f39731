// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "correctives/CorrectiveStray.h"
#include "model/BoundsProxy.h"
#include "model/SkinModelAccess.h"
#include "pose/JointMotions.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace osgSkin {
namespace {

constexpr float kRounding = 1e-6f; ///< of a coordinate: several roundings

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

/// The map of a joint's turn by ratios.
FourMap partialTurn(const BoundsProxy::Term& term, const JointMotion& motion) noexcept {
    const float a = 0.5f * term.bend * motion.bend, b = 0.5f * term.twist * motion.twist;
    const float sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
    const Four u =
        (sa * cb) * motion.bendAxis + (ca * sb) * motion.twistAxis + (sa * sb) * motion.crossAxis;
    const float s = ca * cb, x = u.lane[0], y = u.lane[1], z = u.lane[2];
    FourMap map{
        {{{s * s + x * x - y * y - z * z, 2.0f * (x * y + s * z), 2.0f * (x * z - s * y), 0.0f}},
         {{2.0f * (x * y - s * z), s * s - x * x + y * y - z * z, 2.0f * (y * z + s * x), 0.0f}},
         {{2.0f * (x * z + s * y), 2.0f * (y * z - s * x), s * s - x * x - y * y + z * z, 0.0f}},
         {}}};
    if (motion.scaled != 0.0f)
        for (int i = 0; i < 3; ++i)
            map.column[i] = (1.0f + term.bend * motion.scaled) * map.column[i];
    map.column[3] = motion.centre + term.bend * motion.translation - map.turn(motion.centre);
    return map;
}

/// Adds pieces to a box, but for those that cannot reach out of it.
class BoxOfPieces {
public:
    BoxOfPieces(const BoundsProxy& proxy, const JointMotions& motions) noexcept
        : _proxy(proxy), _motions(motions) {}

    void add(const BoundsProxy::Piece& piece, CorrectiveStray* corrections) noexcept {
        const JointMotion& anchor = _motions.joints[piece.anchor];
        const Strays strays = straysOf(piece);
        if (_motions.plain && (strays.turns || piece.correctionCount > 0)) {
            const JointMotion& home = _motions.joints[piece.home];
            if (holds(home.map * four(piece.rest.centre),
                      home.growthHere * (piece.radius + piece.corrected + strays.fromHome) +
                          _proxy.rounding))
                return;
        }
        const float corrected = corrections ? corrections->of(piece) : 0.0f;
        PosedPiece posed(piece.rest);
        const BoundsProxy::Term* term = _proxy.terms.data() + piece.firstTerm;
        for (const auto* end = term + piece.termCount; strays.turns && term != end; ++term)
            if (term->turns) posed.move(partialTurn(*term, _motions.joints[term->joint]));
        posed.move(anchor.map);
        Four half = posed.half();
        half += anchor.growthHere * (strays.free + strays.grown * corrected) + strays.anchored +
                _proxy.rounding;
        half = half + kRounding * abs(posed.centre);
        low = min(low, posed.centre - half);
        high = max(high, posed.centre + half);
    }

    Four low = all(std::numeric_limits<float>::max());
    Four high = all(-std::numeric_limits<float>::max());

private:
    struct Strays {
        float free = 0.0f;     ///< how far vertices stray before the anchor moves them
        float anchored = 0.0f; ///< how much more by what they have less of the anchor
        float fromHome = 0.0f; ///< how far they can be from where the home joint alone takes them
        float grown = 1.0f;    ///< the scale of those, at least 1
        bool turns = false;
    };

    Strays straysOf(const BoundsProxy::Piece& piece) const noexcept {
        Strays result;
        float before = 0.0f;
        const BoundsProxy::Term* term = _proxy.terms.data() + piece.firstTerm;
        for (const auto* end = term + piece.termCount; term != end; ++term) {
            const JointMotion& motion = _motions.joints[term->joint];
            const float bend = motion.growth * motion.bend + motion.scaling;
            const float twist = motion.growth * std::fabs(motion.twist);
            float stray = bend * (term->bendReach + term->bendSpread * before) +
                          twist * (term->twistReach + term->twistSpread * before) +
                          term->bendSpread * motion.travel;
            float moved = bend * (term->bendMove + term->mostBend * before) +
                          twist * (term->twistMove + term->mostTwist * before) +
                          term->mostBend * motion.travel;
            if (_motions.plain) {
                stray = std::min(stray, term->mostHigh *
                                            (bend * term->bendSpread + twist * term->twistSpread));
                moved = std::min(moved, 2.0f * term->mostHigh);
            }
            result.fromHome += bend * (term->homeBendReach + term->homeBendSpread * before) +
                               twist * (term->homeTwistReach + term->homeTwistSpread * before);
            before += moved;
            if (!term->turns && term->bend == 1.0f) {
                result.anchored += stray;
                continue;
            }
            result.turns = result.turns || term->turns;
            result.free = motion.growth * result.free + stray;
            result.grown *= motion.growth;
        }
        result.anchored *= _motions.joints[piece.anchor].growthHere;
        return result;
    }

    bool holds(const Four& centre, float radius) const noexcept {
        bool inside = true;
        for (int i = 0; i < 3; ++i)
            inside = inside && centre.lane[i] - radius >= low.lane[i] &&
                     centre.lane[i] + radius <= high.lane[i];
        return inside;
    }

    const BoundsProxy& _proxy;
    const JointMotions& _motions;
};

/// A side of the box where it is a number, else as far out as poses may reach.
float bounded(float side, float otherwise) {
    return std::abs(side) <= static_cast<float>(kLargestCoordinate) ? side : otherwise; // NaN too
}

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const BoundsProxy* proxy = SkinModelAccess::boundsProxy(model);
    if (!proxy) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    std::array<JointMotion, 128> few;
    std::vector<JointMotion> many(pose.size() > few.size() ? pose.size() : 0);
    const JointMotions motions(model, pose, many.empty() ? few.data() : many.data());
    std::optional<CorrectiveStray> corrections;
    if (SkinModelAccess::correctives(model)) corrections.emplace(*proxy, model, pose);
    BoxOfPieces box(*proxy, motions);
    for (const BoundsProxy::Piece& piece : proxy->pieces)
        box.add(piece, corrections ? &*corrections : nullptr);
    PoseBounds bounds{box.low.xyz(), box.high.xyz()};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = bounded(bounds.low[axis], -static_cast<float>(kLargestCoordinate));
        bounds.high[axis] = bounded(bounds.high[axis], static_cast<float>(kLargestCoordinate));
    }
    return bounds;
}

} // namespace osgSkin
