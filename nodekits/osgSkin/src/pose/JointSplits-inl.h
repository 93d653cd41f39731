// SPDX-License-Identifier: MIT
//
// Included by PoseKernel.cpp once for each instruction set.
#if defined(OSGSKIN_JOINTSPLITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_JOINTSPLITS_INL_H
#undef OSGSKIN_JOINTSPLITS_INL_H
#else
#define OSGSKIN_JOINTSPLITS_INL_H
#endif

#include <hwy/highway.h>

#include "core/Doubles-inl.h"
#include "pose/PoseKernel.h"

#include <cmath>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// One number of each of up to eight joints, so that roots and divisions overlap.
using JointTag = hn::CappedTag<double, PoseCall::kAtOnce>;
using Joints = hn::Vec<JointTag>;
using JointMask = hn::Mask<JointTag>;

HWY_INLINE Joints each(double x) {
    return hn::Set(JointTag(), x);
}

/// loadFour() of all lanes.
HWY_INLINE void loadFourOf(const double* const* from, std::size_t at, Joints (&to)[4]) {
#if HWY_TARGET <= HWY_AVX3
    Doubles low[4], high[4];
    loadFour(from, at, low);
    loadFour(from + 4, at, high);
    for (std::size_t i = 0; i < 4; ++i) to[i] = hn::Combine(JointTag(), high[i], low[i]);
#else
    loadFour(from, at, to);
#endif
}

/// loadEach() of all lanes.
HWY_INLINE Joints loadEachOf(const double* row, const int* at) {
#if HWY_TARGET <= HWY_AVX3
    return hn::Combine(JointTag(), loadEach(row, at + 4), loadEach(row, at));
#else
    return loadEach(row, at);
#endif
}

/// Reads the parents' numbers of the joints from `first` on.
#if HWY_TARGET <= HWY_AVX3
/// Most joints directly follow their parents, whose numbers are then adjacent; others are inserted.
class ParentRows {
public:
    HWY_INLINE ParentRows(const int* parents, std::size_t first)
        : _parents(parents), _before(first) {
        const JointTag d;
        const hn::Rebind<std::int32_t, JointTag> steps;
        const Joints numbers = hn::Iota(d, 0.0);
        const Joints follow = hn::Add(numbers, each(double(first) - 1.0));
        std::uint8_t bytes[8] = {}; // the most that may be written
        hn::StoreMaskBits(d, hn::Ne(hn::PromoteTo(d, hn::LoadU(steps, parents)), follow), bytes);
        std::uint32_t bits = bytes[0] | 1u << hn::Lanes(d);
        for (std::size_t i = 0; i < kOthers; ++i) {
            const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits); // or past the end
            _isOther[i] = hn::Eq(numbers, each(double(lane)));
            _others[i] = parents[HWY_MIN(lane, hn::Lanes(d) - 1)];
            if (lane < hn::Lanes(d)) bits &= bits - 1;
        }
        _few = bits == 1u << hn::Lanes(d);
    }

    HWY_INLINE Joints operator()(const double* row) const {
        if (HWY_UNLIKELY(!_few)) return loadEachOf(row, _parents);
        Joints result = hn::LoadU(JointTag(), row + _before - 1);
        for (std::size_t i = 0; i < kOthers; ++i)
            result = hn::IfThenElse(_isOther[i], each(row[_others[i]]), result);
        return result;
    }

private:
    static constexpr std::size_t kOthers = 2;

    const int* _parents;
    std::size_t _before;
    int _others[kOthers];
    JointMask _isOther[kOthers];
    bool _few;
};
#else
class ParentRows {
public:
    HWY_INLINE ParentRows(const int* parents, std::size_t) : _parents(parents) {}
    HWY_INLINE Joints operator()(const double* row) const { return loadEachOf(row, _parents); }

private:
    const int* _parents;
};
#endif

/// A frame or a map.
struct Turns {
    Joints turn[3][3]; ///< columns
    Joints offset[3];
    Joints scale;
};

struct Quaternions {
    Joints w, x, y, z;
};

struct Angles {
    Joints bend, twist, cosine, sine; ///< the latter of the bend axis, from e1 towards e2
};

/// The cube root, but 1 for volumes within rounding errors of 1.
HWY_INLINE Joints scaleOf(const Joints& volume) {
    const JointTag d;
    const Joints one = each(1.0);
    const JointMask even = hn::Lt(hn::Abs(hn::Sub(volume, one)), each(3e-6));
    if (HWY_LIKELY(hn::AllTrue(d, even))) return one;
    double lanes[PoseCall::kAtOnce];
    hn::StoreU(volume, d, lanes);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) lanes[lane] = std::cbrt(lanes[lane]);
    return hn::IfThenElse(even, one, hn::LoadU(d, lanes));
}

/// 1 / sqrt(square), to the last few bits; exact for 1. Near 1, as without scale, it needs no root.
HWY_INLINE Joints inverseRoot(const Joints& square) {
    const JointTag d;
    const Joints one = each(1.0), more = hn::Sub(square, one);
    if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Lt(hn::Abs(more), each(1e-4))))) // NaN too
        return hn::Div(one, hn::Sqrt(square));
    const Joints terms = hn::MulAdd(more, hn::MulAdd(more, each(-0.3125), each(0.375)), each(-0.5));
    return hn::MulAdd(more, terms, one);
}

struct Root {
    Joints root, inverse;
};

/// The root of a normal number, to the last digits.
HWY_INLINE Root rootOf(const Joints& square) {
#if HWY_TARGET <= HWY_AVX3
    // Two Newton steps: the exact instructions take three times as long.
    Joints inverse{_mm512_rsqrt14_pd(square.raw)};
    const Joints half = hn::Mul(each(0.5), square), more = each(1.5);
    for (int i = 0; i < 2; ++i)
        inverse = hn::Mul(inverse, hn::NegMulAdd(half, hn::Mul(inverse, inverse), more));
    return {hn::Mul(square, inverse), inverse};
#else
    const Joints root = hn::Sqrt(square);
    return {root, hn::Div(each(1.0), root)};
#endif
}

/// The quaternions of rotations, starting from the largest component.
HWY_INLINE Quaternions quaternionsOf(const Joints (&m)[3][3]) {
    const JointTag d;
    const Joints one = each(1.0), half = each(0.5);
    const Joints xPlusY = hn::Add(m[0][0], m[1][1]), xLessY = hn::Sub(m[0][0], m[1][1]);
    const Joints forW = hn::Add(xPlusY, m[2][2]), forX = hn::Sub(xLessY, m[2][2]);
    const Joints forY = hn::Neg(hn::Add(xLessY, m[2][2])), forZ = hn::Sub(m[2][2], xPlusY);
    const Joints largestAxis = hn::Max(forX, hn::Max(forY, forZ));
    const Joints square = hn::Add(hn::Max(forW, largestAxis), one);
    const Root root = rootOf(square);
    const Joints largest = hn::Mul(half, root.root), factor = hn::Mul(half, root.inverse);
    const Joints lessX = hn::Mul(factor, hn::Sub(m[1][2], m[2][1]));
    const Joints lessY = hn::Mul(factor, hn::Sub(m[2][0], m[0][2]));
    const Joints lessZ = hn::Mul(factor, hn::Sub(m[0][1], m[1][0]));
    const JointMask isW = hn::Ge(forW, largestAxis);
    Quaternions q{largest, lessX, lessY, lessZ};
    if (HWY_LIKELY(hn::AllTrue(d, isW))) return q;
    const Joints xy = hn::Mul(factor, hn::Add(m[0][1], m[1][0]));
    const Joints yz = hn::Mul(factor, hn::Add(m[1][2], m[2][1]));
    const Joints zx = hn::Mul(factor, hn::Add(m[2][0], m[0][2]));
    const JointMask isX = hn::Eq(forX, largestAxis), isY = hn::Eq(forY, largestAxis);
    const auto choose = [&](Joints w, Joints x, Joints y, Joints z) HWY_ATTR {
        return hn::IfThenElse(isW, w, hn::IfThenElse(isX, x, hn::IfThenElse(isY, y, z)));
    };
    q.w = choose(q.w, lessX, lessY, lessZ);
    q.x = choose(q.x, largest, xy, zx);
    q.y = choose(q.y, xy, largest, yz);
    q.z = choose(q.z, zx, yz, largest);
    return q;
}

/// splitUnit() of a joint too close to a half turn for the code below.
inline HWY_NOINLINE void splitAlone(const PoseCall& call, std::size_t joint, const double (&q)[4],
                                    double (&angles)[4]) {
    const auto rest = [&](std::size_t row) {
        const double* at = call.rest + row * call.count + joint;
        return glm::dvec3(at[0], at[call.count], at[2 * call.count]);
    };
    const BendTwist split = splitUnit({q[0], q[1], q[2], q[3]}, rest(PoseAccess::RestRow::kPole));
    angles[0] = split.bendAngle;
    angles[1] = split.twistAngle;
    angles[2] = glm::dot(split.bendAxis, rest(PoseAccess::RestRow::kE1));
    angles[3] = glm::dot(split.bendAxis, rest(PoseAccess::RestRow::kE2));
}

inline HWY_NOINLINE void splitAlone(const PoseCall& call, std::size_t first,
                                    const double (&q)[4][PoseCall::kAtOnce], const double* alone,
                                    double (&angles)[4][PoseCall::kAtOnce]) {
    for (std::size_t lane = 0; lane < hn::Lanes(JointTag()); ++lane) {
        if (alone[lane] == 0.0) continue;
        double own[4];
        splitAlone(call, first + lane, {q[0][lane], q[1][lane], q[2][lane], q[3][lane]}, own);
        for (std::size_t i = 0; i < 4; ++i) angles[i][lane] = own[i];
    }
}

/// splitUnit() of several joints.
HWY_INLINE Angles split(const PoseCall& call, std::size_t first, const Quaternions& q) {
    /// Below this sine of half the bend, there is no bend axis.
    constexpr double kNoBend = 1e-100;
    /// Below this cosine of half the bend, the twist is not determined.
    constexpr double kHalfTurn = 1e-12;
    const JointTag d;
    const Joints zero = hn::Zero(d), one = each(1.0), two = each(2.0);
    const Joints xyz[3] = {q.x, q.y, q.z};
    const auto along = [&](std::size_t row) HWY_ATTR {
        const double* at = call.rest + row * call.count + first;
        const Joints axis[3] = {hn::LoadU(d, at), hn::LoadU(d, at + call.count),
                                hn::LoadU(d, at + 2 * call.count)};
        return dot(xyz, axis);
    };
    // c + s w is the twist, u1 e1 + u2 e2 the part perpendicular to w; of q and -q the one with
    // positive c.
    const Joints sign = hn::And(q.w, hn::SignBit(d));
    const Joints c = hn::Xor(q.w, sign);
    const Joints s = hn::Xor(along(PoseAccess::RestRow::kPole), sign);
    const Joints u1 = hn::Xor(along(PoseAccess::RestRow::kE1), sign);
    const Joints u2 = hn::Xor(along(PoseAccess::RestRow::kE2), sign);
    const Joints cosines = hn::MulAdd(c, c, hn::Mul(s, s));
    const Joints sines = hn::MulAdd(u1, u1, hn::Mul(u2, u2));
    const JointMask bends = hn::Ge(sines, each(kNoBend * kNoBend));
    const Root cosine = rootOf(cosines), sine = rootOf(hn::IfThenElse(bends, sines, one));
    Angles angles;
    angles.bend = hn::IfThenElseZero(bends, hn::Mul(two, angleOf(sine.root, cosine.root)));
    angles.twist = hn::Mul(two, angleOf(s, c));
    // q times the inverse twist: eq. 3.
    const Joints length = hn::Mul(sine.inverse, cosine.inverse);
    angles.cosine = hn::Mul(hn::MulSub(c, u1, hn::Mul(s, u2)), length);
    angles.sine = hn::Mul(hn::MulAdd(c, u2, hn::Mul(s, u1)), length);
    angles.cosine = hn::IfThenElse(bends, angles.cosine, one);
    angles.sine = hn::IfThenElseZero(bends, angles.sine);
    const JointMask alone = hn::Or(hn::Eq(c, zero), hn::Lt(cosines, each(kHalfTurn * kHalfTurn)));
    if (HWY_LIKELY(hn::AllFalse(d, alone))) return angles;
    constexpr std::size_t kAtOnce = PoseCall::kAtOnce;
    double quaternions[4][kAtOnce], all[4][kAtOnce], which[kAtOnce];
    Joints* const parts[4] = {&angles.bend, &angles.twist, &angles.cosine, &angles.sine};
    const Joints* const from[4] = {&q.w, &q.x, &q.y, &q.z};
    for (std::size_t i = 0; i < 4; ++i) {
        hn::StoreU(*from[i], d, quaternions[i]);
        hn::StoreU(*parts[i], d, all[i]);
    }
    hn::StoreU(hn::IfThenElseZero(alone, one), d, which);
    splitAlone(call, first, quaternions, which, all);
    for (std::size_t i = 0; i < 4; ++i) *parts[i] = hn::LoadU(d, all[i]);
    return angles;
}

/// `twist` or 2 pi more or less, see Pose::Twist.
HWY_INLINE Joints continued(const Joints& before, const Joints& twist) {
    const Joints turn = each(6.283185307179586477), quarter = each(0.25 * 6.283185307179586477);
    const Joints limit = each(0.75 * 6.283185307179586477); // else twists would wind up
    Joints result = twist;
    const auto choose = [&](const Joints& angle) HWY_ATTR {
        const JointMask good = hn::And(hn::Lt(hn::Abs(angle), limit),
                                       hn::Le(hn::Abs(hn::Sub(angle, before)), quarter));
        result = hn::IfThenElse(good, angle, result);
    };
    // The last one in range wins.
    choose(hn::Sub(twist, turn));
    choose(hn::Add(twist, turn));
    choose(twist);
    return result;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
