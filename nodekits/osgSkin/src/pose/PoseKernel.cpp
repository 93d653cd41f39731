// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set by foreach_target.h, which includes this file again and
// again; the best one is chosen at run time.
#include "pose/PoseKernel.h"

#include "pose/SplitUnit.h"

#include <cfloat>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pose/PoseKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "points/Doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// A number of up to eight joints each: what waits for roots and quotients is done beside each
/// other.
using JointTag = hn::CappedTag<double, PoseCall::kAtOnce>;
using Joints = hn::Vec<JointTag>;
using JointMask = hn::Mask<JointTag>;

HWY_INLINE Joints each(double x) {
    return hn::Set(JointTag(), x);
}

/// loadFour() of all lanes.
HWY_INLINE void loadFourOf(const double* const* from, std::size_t at, Joints (&to)[4]) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
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
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return hn::Combine(JointTag(), loadEach(row, at + 4), loadEach(row, at));
#else
    return loadEach(row, at);
#endif
}

/// Reads numbers of the parents of joints from `first` on.
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
/// Most joints follow their parents, whose numbers stand side by side then; what others there are
/// is put between those.
class ParentRows {
public:
    HWY_INLINE ParentRows(const int* parents, std::size_t first)
        : _parents(parents), _before(first) {
        const JointTag d;
        const hn::Rebind<std::int32_t, JointTag> steps;
        const Joints numbers = hn::Iota(d, 0.0);
        const Joints follow = hn::Add(numbers, each(double(first) - 1.0));
        std::uint8_t bytes[8] = {}; // as many as may be written
        hn::StoreMaskBits(d, hn::Ne(hn::PromoteTo(d, hn::LoadU(steps, parents)), follow), bytes);
        std::uint32_t bits = bytes[0] | 1u << hn::Lanes(d);
        for (std::size_t i = 0; i < kOthers; ++i) {
            const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits); // behind all: none
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

/// What is read of a frame or a map.
struct Turns {
    Joints turn[3][3]; ///< columns
    Joints offset[3];
    Joints scale;
};

struct Quaternions {
    Joints w, x, y, z;
};

struct Angles {
    Joints bend, twist, cosine, sine; ///< the latter of the bend axis, from e1 to e2
};

/// Cube roots of what volumes are far from 1. Numbers of a file or rotation are rounded, which is
/// no scale; and a root takes its time.
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

/// 1 / sqrt(square), to the last few bits; exact for 1. Axes of bones that are not scaled are of
/// length 1 but for rounding: no division then, and no root.
HWY_INLINE Joints inverseRoot(const Joints& square) {
    const JointTag d;
    const Joints one = each(1.0), more = hn::Sub(square, one);
    if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Lt(hn::Abs(more), each(1e-4))))) // NaN too
        return hn::Div(one, hn::Sqrt(square));
    const Joints terms = hn::MulAdd(more, hn::MulAdd(more, each(-0.3125), each(0.375)), each(-0.5));
    return hn::MulAdd(more, terms, one);
}

bool readFrames(const glm::dmat4* skinning, const PoseCall& call, const PoseFrames& frames) {
    const JointTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Joints zero = hn::Zero(d), one = each(1.0), most = each(DBL_MAX);
    const Joints rounding = each(1e-3), farthest = each(kLargestCoordinate);
    JointMask good = hn::Eq(zero, zero);
    const auto require = [&good](const JointMask& that) HWY_ATTR { good = hn::And(good, that); };
    for (std::size_t row = 0; row < kFrameRows; ++row) // no turn
        frames.rows[row * frames.stride - 1] = row == 0 || row == 4 || row == 8 || row == 12;
    for (std::size_t next = 0; next < call.count; next += lanes) {
        const std::size_t first = HWY_MIN(next, call.count - lanes); // the last ones overlap
        const double* from[PoseCall::kAtOnce];
        for (std::size_t lane = 0; lane < lanes; ++lane) from[lane] = &skinning[first + lane][0][0];
        Joints m[4][4];
        for (std::size_t column = 0; column < 4; ++column) loadFourOf(from, 4 * column, m[column]);
        // Written so that NaN is refused.
        for (std::size_t column = 0; column < 3; ++column)
            require(hn::Lt(hn::Abs(m[column][3]), rounding));
        require(hn::Lt(hn::Abs(hn::Sub(m[3][3], one)), rounding));

        Joints x[3] = {m[0][0], m[0][1], m[0][2]}, y[3] = {m[1][0], m[1][1], m[1][2]};
        const Joints z[3] = {m[2][0], m[2][1], m[2][2]};
        const Joints xx = dot(x, x);
        require(hn::And(hn::Gt(xx, zero), hn::Le(xx, most)));
        const Joints xLength = inverseRoot(xx);
        const Joints share = hn::Mul(hn::Mul(dot(x, y), xLength), xLength);
        for (std::size_t axis = 0; axis < 3; ++axis)
            y[axis] = hn::NegMulAdd(x[axis], share, y[axis]);
        const Joints yy = dot(y, y);
        require(hn::And(hn::Gt(yy, hn::Mul(each(1e-24), xx)), hn::Le(yy, most)));
        Joints across[3];
        cross(x, y, across);
        const Joints volume = hn::Abs(dot(across, z));
        require(hn::And(hn::Ge(volume, each(kSmallestVolume)),
                        hn::Le(volume, each(1.0 / kSmallestVolume))));
        const Joints scale = scaleOf(volume);
        const Joints yLength = inverseRoot(yy);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            x[axis] = hn::Mul(x[axis], xLength);
            y[axis] = hn::Mul(y[axis], yLength);
        }
        cross(x, y, across);

        const auto store = [&](std::size_t row, const Joints& value) HWY_ATTR {
            hn::StoreU(value, d, frames.rows + row * frames.stride + first);
        };
        const auto rest = [&](std::size_t row) HWY_ATTR {
            return hn::LoadU(d, call.rest + row * call.count + first);
        };
        const Joints centre[3] = {rest(PoseAccess::RestRow::kCentre),
                                  rest(PoseAccess::RestRow::kCentre + 1),
                                  rest(PoseAccess::RestRow::kCentre + 2)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // The joint centre goes where the whole matrix, non-uniform scale included, puts it.
            const Joints all[3] = {m[0][axis], m[1][axis], m[2][axis]};
            const Joints turn[3] = {x[axis], y[axis], across[axis]};
            const Joints offset =
                hn::NegMulAdd(scale, dot(turn, centre), hn::Add(dot(all, centre), m[3][axis]));
            require(hn::Le(hn::Abs(offset), farthest));
            store(axis, x[axis]);
            store(3 + axis, y[axis]);
            store(6 + axis, across[axis]);
            store(9 + axis, offset);
        }
        store(12, scale);
    }
    return hn::AllTrue(d, good);
}

struct Root {
    Joints root, inverse;
};

/// Of what is not 0, nor denormal; to the last digits.
HWY_INLINE Root rootOf(const Joints& square) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    // Two of Newton's steps: the instructions for it take three times as long.
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

/// Of a rotation, with that part found first which is largest.
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

/// What is too near to a half turn for the arithmetic of the others.
HWY_NOINLINE void splitAlone(const PoseCall& call, std::size_t joint, const double (&q)[4],
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

HWY_NOINLINE void splitAlone(const PoseCall& call, std::size_t first,
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
    /// Bend axes are nothing below this sine of half the bend.
    constexpr double kNoBend = 1e-100;
    /// Below this cosine of half the bend, its axis and the twist are not told apart.
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
    // c + s w is the twist, u1 e1 + u2 e2 what is perpendicular to w; of q and -q the one where c
    // is positive.
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
    const Joints turn = each(6.283185307179586477), near = each(0.25 * 6.283185307179586477);
    Joints result = twist;
    const auto choose = [&](const Joints& angle) HWY_ATTR {
        const JointMask good =
            hn::And(hn::Lt(hn::Abs(angle), turn), hn::Le(hn::Abs(hn::Sub(angle, before)), near));
        result = hn::IfThenElse(good, angle, result);
    };
    // The first that is good is to be taken, so it comes last.
    choose(hn::Sub(twist, turn));
    choose(hn::Add(twist, turn));
    choose(twist);
    return result;
}

/// Writes numbers of joints; returns where they are others than before.
HWY_INLINE JointMask put(const Joints& value, double* to) {
    const JointTag d;
    const JointMask other = hn::Ne(value, hn::LoadU(d, to));
    hn::StoreU(value, d, to);
    return other;
}

/// Writes how joints turn and move; returns where they do otherwise than before.
HWY_INLINE JointMask writeMaps(const PoseCall& call, std::size_t first, const Quaternions& q,
                               const Joints (&offset)[3], const Joints& scale) {
    using Access = PoseAccess::Row;
    const auto row = [&](std::size_t number) { return call.rows + first + number * call.count; };
    JointMask other = put(q.w, row(Access::kW));
    other = hn::Or(other, put(q.x, row(Access::kX)));
    other = hn::Or(other, put(q.y, row(Access::kY)));
    other = hn::Or(other, put(q.z, row(Access::kZ)));
    for (std::size_t axis = 0; axis < 3; ++axis)
        other = hn::Or(other, put(offset[axis], row(Access::kOffset + axis)));
    return hn::Or(other, put(scale, row(Access::kScale)));
}

/// Splits what joints' rows turn by; returns where twists are others than before. A loop of its
/// own: much waits for roots and quotients, and the shorter that is, the more joints wait together.
JointMask splitRows(const PoseCall& call) {
    using Access = PoseAccess::Row;
    const JointTag d;
    const hn::Rebind<std::int32_t, JointTag> steps;
    JointMask other = hn::Lt(each(1.0), each(1.0));
    for (std::size_t next = 0; next < call.count; next += hn::Lanes(d)) {
        const std::size_t first = HWY_MIN(next, call.count - hn::Lanes(d)); // the last ones overlap
        double* const at = call.rows + first;
        const auto own = [&](std::size_t row)
                             HWY_ATTR { return hn::LoadU(d, at + row * call.count); };
        Angles angles = split(call, first,
                              {own(Access::kW), own(Access::kX), own(Access::kY), own(Access::kZ)});
        if (HWY_UNLIKELY(call.continued))
            angles.twist = continued(own(Access::kTwist), angles.twist);
        hn::StoreU(angles.bend, d, at + Access::kBend * call.count);
        other = hn::Or(other, put(angles.twist, at + Access::kTwist * call.count));
        // As good as the kernel's floats, in half of a double's room.
        const auto inSteps = [&](const Joints& x) HWY_ATTR {
            const Joints of = hn::Mul(x, each(1.0 / PoseAccess::kAzimuthStep));
            return hn::DemoteTo(steps, hn::Add(of, hn::CopySign(each(0.5), of)));
        };
        // Read and written as vectors and bytes only, which may be anything.
        auto* const azimuths =
            reinterpret_cast<std::int32_t*>(call.rows + Access::kAzimuth * call.count);
        hn::StoreU(inSteps(angles.cosine), steps, azimuths + first);
        hn::StoreU(inSteps(angles.sine), steps, azimuths + call.count + first);
    }
    return other;
}

bool splitFrames(const PoseCall& call, const PoseFrames& frames) {
    const JointTag d;
    const Joints one = each(1.0);
    JointMask other = hn::Lt(one, one);
    for (std::size_t next = 0; next < call.count; next += hn::Lanes(d)) {
        const std::size_t first = HWY_MIN(next, call.count - hn::Lanes(d)); // the last ones overlap
        const auto own = [&](std::size_t row) HWY_ATTR {
            return hn::LoadU(d, frames.rows + row * frames.stride + first);
        };
        const ParentRows parentRows(call.parents + first, first);
        const auto above = [&](std::size_t row)
                               HWY_ATTR { return parentRows(frames.rows + row * frames.stride); };
        Joints turn[3][3], offset[3], shift[3];
        const Joints turned[3][3] = {
            {own(0), own(1), own(2)}, {own(3), own(4), own(5)}, {own(6), own(7), own(8)}};
        for (std::size_t axis = 0; axis < 3; ++axis)
            shift[axis] = hn::Sub(own(9 + axis), above(9 + axis));
        for (std::size_t row = 0; row < 3; ++row) {
            const Joints back[3] = {above(3 * row), above(3 * row + 1), above(3 * row + 2)};
            for (std::size_t column = 0; column < 3; ++column)
                turn[column][row] = dot(back, turned[column]);
            offset[row] = dot(back, shift);
        }
        Joints scale = own(12);
        const Joints before = above(12);
        if (HWY_UNLIKELY(!hn::AllTrue(d, hn::And(hn::Eq(scale, one), hn::Eq(before, one))))) {
            for (Joints& axis : offset) axis = hn::Div(axis, before);
            scale = hn::Div(scale, before);
            scale = hn::IfThenElse(hn::Lt(hn::Abs(hn::Sub(scale, one)), each(1e-6)), one, scale);
        }
        other = hn::Or(other, writeMaps(call, first, quaternionsOf(turn), offset, scale));
    }
    return !hn::AllFalse(d, hn::Or(other, splitRows(call)));
}

bool splitMaps(const PoseCall& call, const JointMap* own) {
    static_assert(isPacked<JointMap, double, 8>() && offsetof(JointMap, offset) == 32);
    const JointTag d;
    JointMask other = hn::Lt(each(1.0), each(1.0));
    for (std::size_t next = 0; next < call.count; next += hn::Lanes(d)) {
        const std::size_t first = HWY_MIN(next, call.count - hn::Lanes(d)); // the last ones overlap
        const double* from[PoseCall::kAtOnce];
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
            from[lane] = reinterpret_cast<const double*>(&own[first + lane].rotation.x);
        Joints q[4], rest[4]; // x, y, z, w
        loadFourOf(from, 0, q);
        loadFourOf(from, 4, rest);
        const Joints offset[3] = {rest[0], rest[1], rest[2]};
        other = hn::Or(other, writeMaps(call, first, {q[3], q[0], q[1], q[2]}, offset, rest[3]));
    }
    return !hn::AllFalse(d, hn::Or(other, splitRows(call)));
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(readFrames);
HWY_EXPORT(splitFrames);
HWY_EXPORT(splitMaps);

bool readFrames(const glm::dmat4* skinning, const PoseCall& call,
                const PoseFrames& frames) noexcept {
    return HWY_DYNAMIC_DISPATCH(readFrames)(skinning, call, frames);
}

bool splitFrames(const PoseCall& call, const PoseFrames& frames) noexcept {
    return HWY_DYNAMIC_DISPATCH(splitFrames)(call, frames);
}

bool splitMaps(const PoseCall& call, const JointMap* own) noexcept {
    return HWY_DYNAMIC_DISPATCH(splitMaps)(call, own);
}

} // namespace osgSkin
#endif
