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
#include "core/Doubles-inl.h"
#include "model/BoundsProxy.h"
#include "pose/PoseKernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

using MotionTag = hn::Rebind<float, DoubleTag>;
using Motions = hn::Vec<MotionTag>; ///< a number of several joints each

/// Rounding errors become 0: their products would be denormal numbers, which are slow.
HWY_INLINE Motions flushed(const Doubles& x, double least) {
    const auto large = hn::Ge(hn::Abs(x), allOf(least));
    return hn::DemoteTo(MotionTag(), hn::IfThenElseZero(large, x));
}

/// Stores four adjacent numbers of each joint.
///
/// \param at their offset in JointMotion, bytes
HWY_INLINE void storeFour(Motions x, Motions y, Motions z, Motions w, JointMotion* joints,
                          std::size_t at) {
    char* const to = reinterpret_cast<char*>(joints) + at;
    constexpr std::size_t kNext = sizeof(JointMotion);
#if HWY_TARGET <= HWY_AVX2
    _MM_TRANSPOSE4_PS(x.raw, y.raw, z.raw, w.raw);
    std::memcpy(to, &x.raw, sizeof x.raw);
    std::memcpy(to + kNext, &y.raw, sizeof y.raw);
    std::memcpy(to + 2 * kNext, &z.raw, sizeof z.raw);
    std::memcpy(to + 3 * kNext, &w.raw, sizeof w.raw);
#else
    const MotionTag d;
    float lanes[4][4];
    hn::StoreU(x, d, lanes[0]);
    hn::StoreU(y, d, lanes[1]);
    hn::StoreU(z, d, lanes[2]);
    hn::StoreU(w, d, lanes[3]);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        const float own[4] = {lanes[0][lane], lanes[1][lane], lanes[2][lane], lanes[3][lane]};
        std::memcpy(to + lane * kNext, own, sizeof own);
    }
#endif
}

HWY_INLINE float lengthOf(const Four& a) noexcept {
    const Four squares = a * a;
    return std::sqrt(squares[0] + squares[1] + squares[2]);
}

/// The motions of the joints that a proxy needs.
class JointMotions {
public:
    /// \param proxy of the pose's model
    /// \param pose of the model's joints
    /// \param room see boxOf()
    JointMotions(const BoundsProxy& proxy, const Pose& pose, JointMotion* room) noexcept;

    const JointMotion& operator[](std::uint32_t joint) const noexcept { return _joints[joint]; }

    /// Whether no joint is scaled, and none but the root is translated.
    bool isPlain() const noexcept { return _plain; }

    /// The map of a joint's partial rotation.
    FourMap partialTurn(const BoundsProxy::Term& term) const noexcept;

private:
    const BoundsProxy& _proxy;
    JointMotion* _joints;
    bool _plain = true;
};

/// A pose's rows, padded where it has fewer joints than are processed at a time.
class MotionRows {
public:
    HWY_INLINE explicit MotionRows(const Pose& pose) : _count(pose.size()) {
        constexpr std::size_t kAtOnce = PoseAccess::kAtOnce;
        _rows = PoseAccess::rows(pose);
        _azimuths = PoseAccess::azimuths(_rows, _count);
        if (HWY_LIKELY(_count >= kAtOnce)) return;
        for (std::size_t i = 0; i < kAtOnce; ++i) {
            const std::size_t joint = HWY_MIN(i, _count - 1);
            for (std::size_t row = 0; row < PoseAccess::kNumberRows; ++row)
                _few[row * kAtOnce + i] = _rows[row * _count + joint];
            for (std::size_t row = 0; row < 2; ++row)
                _fewAzimuths[row * kAtOnce + i] = _azimuths[row * _count + joint];
        }
        _rows = _few;
        _azimuths = _fewAzimuths;
        _count = kAtOnce;
    }

    std::size_t count() const { return _count; }
    HWY_INLINE Doubles row(std::size_t row, std::size_t first) const {
        return hn::LoadU(DoubleTag(), _rows + row * _count + first);
    }
    HWY_INLINE Motions azimuth(std::size_t row, std::size_t first) const {
        const hn::Rebind<std::int32_t, DoubleTag> steps;
        return hn::Mul(
            hn::ConvertTo(MotionTag(), hn::LoadU(steps, _azimuths + row * _count + first)),
            hn::Set(MotionTag(), static_cast<float>(PoseAccess::kAzimuthStep)));
    }

private:
    std::size_t _count;
    const double* _rows;
    const std::int32_t* _azimuths;
    double _few[PoseAccess::kNumberRows * PoseAccess::kAtOnce];
    std::int32_t _fewAzimuths[2 * PoseAccess::kAtOnce];
};

/// Computes the motions of joints from `first` on relative to their parents, without scale.
HWY_INLINE void moveJoints(const MotionRows& rows, std::size_t first, JointMotion* joints) {
    using Row = PoseAccess::Row;
    const MotionTag d;
    const Motions zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const auto part = [&](std::size_t row) HWY_ATTR { return flushed(rows.row(row, first), 1e-8); };
    const Motions w = part(Row::kW), x = part(Row::kX), y = part(Row::kY), z = part(Row::kZ);
    const Motions x2 = hn::Add(x, x), y2 = hn::Add(y, y), z2 = hn::Add(z, z);
    const Motions xx = hn::Mul(x2, x), yy = hn::Mul(y2, y), zz = hn::Mul(z2, z);
    const Motions xy = hn::Mul(x2, y), yz = hn::Mul(y2, z), zx = hn::Mul(z2, x);
    const auto store = [&](std::size_t at, Motions a, Motions b, Motions c, Motions e)
                           HWY_ATTR { storeFour(a, b, c, e, joints + first, at); };
    constexpr std::size_t kColumns = offsetof(JointMotion, map), kColumn = sizeof(Four);
    store(kColumns, hn::Sub(hn::Sub(one, yy), zz), hn::MulAdd(z2, w, xy), hn::NegMulAdd(y2, w, zx),
          zero);
    store(kColumns + kColumn, hn::NegMulAdd(z2, w, xy), hn::Sub(hn::Sub(one, xx), zz),
          hn::MulAdd(x2, w, yz), zero);
    store(kColumns + 2 * kColumn, hn::MulAdd(y2, w, zx), hn::NegMulAdd(x2, w, yz),
          hn::Sub(hn::Sub(one, xx), yy), zero);
    const auto offset = [&](std::size_t axis) HWY_ATTR {
        return hn::DemoteTo(d, rows.row(Row::kOffset + axis, first));
    };
    store(kColumns + 3 * kColumn, offset(0), offset(1), offset(2), zero);
    const Motions bend = flushed(rows.row(Row::kBend, first), 1e-9);
    const Motions twist = flushed(rows.row(Row::kTwist, first), 1e-9);
    const Motions both = hn::Add(bend, hn::Abs(twist));
    store(offsetof(JointMotion, bend), bend, hn::Abs(twist), hn::Mul(both, both), twist);
    const Doubles scale = rows.row(Row::kScale, first);
    store(offsetof(JointMotion, cosine), rows.azimuth(0, first), rows.azimuth(1, first),
          hn::DemoteTo(d, scale), hn::DemoteTo(d, hn::Sub(scale, allOf(1.0))));
    store(offsetof(JointMotion, travel), zero, zero, one, one);
}

HWY_INLINE JointMotions::JointMotions(const BoundsProxy& proxy, const Pose& pose,
                                      JointMotion* room) noexcept
    : _proxy(proxy), _joints(room) {
    if (proxy.joints.empty()) return;
    const MotionRows rows(pose);
    const std::size_t lanes = hn::Lanes(MotionTag());
    for (std::size_t next = 0; next < rows.count(); next += lanes) // the last ones overlap
        moveJoints(rows, HWY_MIN(next, rows.count() - lanes), room);
    for (std::size_t j = 0; j < proxy.joints.size(); ++j) {
        const BoundsProxy::Joint& rest = proxy.joints[j];
        if (!rest.isNeeded) continue;
        JointMotion& joint = room[j];
        if (joint.scaled != 0.0f) {
            _plain = false;
            for (int i = 0; i < 3; ++i) joint.map.column[i] = joint.scale * joint.map.column[i];
            joint.scaling = std::fabs(joint.scaled);
            joint.growth = joint.growthHere = std::max(1.0f, joint.scale);
        }
        if (rest.parent < 0) continue;
        const JointMotion& above = room[rest.parent];
        joint.translation = joint.map * rest.centre - rest.centre;
        joint.map = above.map * joint.map;
        joint.growthHere *= above.growthHere;
        const Four way = abs(joint.translation);
        if (!(way[0] + way[1] + way[2] <= proxy.noTravel)) { // NaN too
            joint.travel = lengthOf(joint.translation);
            _plain = false;
        }
    }
}

HWY_INLINE FourMap JointMotions::partialTurn(const BoundsProxy::Term& term) const noexcept {
    const JointMotion& joint = _joints[term.joint];
    const BoundsProxy::Joint& rest = _proxy.joints[term.joint];
    // The bend v with its axis cosine e1 + sine e2, after the twist about w; v x w is
    // sine e1 - cosine e2.
    const Four of =
        sinesAndCosines(0.5f * term.bend * joint.bend, 0.5f * term.twist * joint.signedTwist);
    const float right = of[0] * of[3], up = of[0] * of[1];
    Four q = (right * joint.cosine + up * joint.sine) * rest.e1 +
             (right * joint.sine - up * joint.cosine) * rest.e2 + (of[2] * of[1]) * rest.twistAxis;
    q.v[3] = of[2] * of[3];
    FourMap map = rotation(q);
    if (joint.scaled != 0.0f)
        for (int i = 0; i < 3; ++i)
            map.column[i] = (1.0f + term.bend * joint.scaled) * map.column[i];
    map.column[3] = rest.centre - map.turn(rest.centre);
    if (joint.travel != 0.0f) map.column[3] = map.column[3] + term.bend * joint.translation;
    return map;
}

constexpr float kRounding = 2e-6f; ///< of a coordinate: several roundings

/// A cylinder while it is posed.
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

/// The boxes of single pieces in a pose.
class PosedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions the pose's
    PosedPieces(const BoundsProxy& proxy, const JointMotions& motions) noexcept
        : _proxy(proxy), _motions(motions) {}

    /// The box of a piece that is rotated as its vertices are.
    ///
    /// \param corrected how far correctives move its vertices
    Box4 turned(const BoundsProxy::Piece& piece, float corrected) const noexcept;

private:
    struct Strays {
        float free = 0.0f;     ///< how far vertices deviate before the anchor moves them
        float anchored = 0.0f; ///< how much more, by ratios below the anchor's
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

HWY_INLINE Box4 PosedPieces::turned(const BoundsProxy::Piece& piece,
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
