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

/// What is read of a frame or a map.
struct Turns {
    Doubles turn[3][3]; ///< columns
    Doubles offset[3];
    Doubles scale;
};

struct Quaternions {
    Doubles w, x, y, z;
};

struct Angles {
    Doubles bend, twist, cosine, sine; ///< the latter of the bend axis, from e1 to e2
};

/// Cube roots of what volumes are far from 1. Numbers of a file or rotation are rounded, which is
/// no scale; and a root takes its time.
HWY_INLINE Doubles scaleOf(const Doubles& volume) {
    const DoubleTag d;
    const Doubles one = allOf(1.0);
    const DoubleMask even = hn::Lt(hn::Abs(hn::Sub(volume, one)), allOf(3e-6));
    if (HWY_LIKELY(hn::AllTrue(d, even))) return one;
    double lanes[4];
    hn::StoreU(volume, d, lanes);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) lanes[lane] = std::cbrt(lanes[lane]);
    return hn::IfThenElse(even, one, hn::LoadU(d, lanes));
}

bool readFrames(const glm::dmat4* skinning, const PoseCall& call, const PoseFrames& frames) {
    const DoubleTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Doubles zero = hn::Zero(d), one = allOf(1.0), most = allOf(DBL_MAX);
    const Doubles rounding = allOf(1e-3), farthest = allOf(kLargestCoordinate);
    DoubleMask good = hn::Eq(zero, zero);
    const auto require = [&good](const DoubleMask& that) HWY_ATTR { good = hn::And(good, that); };
    for (std::size_t row = 0; row < kFrameRows; ++row) // no turn
        frames.rows[row * frames.stride - 1] = row == 0 || row == 4 || row == 8 || row == 12;
    for (std::size_t next = 0; next < call.count; next += lanes) {
        const std::size_t first = HWY_MIN(next, call.count - lanes); // the last ones overlap
        const double* from[4];
        for (std::size_t lane = 0; lane < lanes; ++lane) from[lane] = &skinning[first + lane][0][0];
        Doubles m[4][4];
        for (std::size_t column = 0; column < 4; ++column) loadFour(from, 4 * column, m[column]);
        // Written so that NaN is refused.
        for (std::size_t column = 0; column < 3; ++column)
            require(hn::Lt(hn::Abs(m[column][3]), rounding));
        require(hn::Lt(hn::Abs(hn::Sub(m[3][3], one)), rounding));

        Doubles x[3] = {m[0][0], m[0][1], m[0][2]}, y[3] = {m[1][0], m[1][1], m[1][2]};
        const Doubles z[3] = {m[2][0], m[2][1], m[2][2]};
        const Doubles xx = dot(x, x);
        require(hn::And(hn::Gt(xx, zero), hn::Le(xx, most)));
        const Doubles share = hn::Div(dot(x, y), xx);
        for (std::size_t axis = 0; axis < 3; ++axis)
            y[axis] = hn::NegMulAdd(x[axis], share, y[axis]);
        const Doubles yy = dot(y, y);
        require(hn::And(hn::Gt(yy, hn::Mul(allOf(1e-24), xx)), hn::Le(yy, most)));
        Doubles across[3];
        cross(x, y, across);
        const Doubles volume = hn::Abs(dot(across, z));
        require(hn::And(hn::Ge(volume, allOf(kSmallestVolume)),
                        hn::Le(volume, allOf(1.0 / kSmallestVolume))));
        const Doubles scale = scaleOf(volume);
        const Doubles xLength = hn::Div(one, hn::Sqrt(xx)), yLength = hn::Div(one, hn::Sqrt(yy));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            x[axis] = hn::Mul(x[axis], xLength);
            y[axis] = hn::Mul(y[axis], yLength);
        }
        cross(x, y, across);

        const auto store = [&](std::size_t row, const Doubles& value) HWY_ATTR {
            hn::StoreU(value, d, frames.rows + row * frames.stride + first);
        };
        const auto rest = [&](std::size_t row) HWY_ATTR {
            return hn::LoadU(d, call.rest + row * call.count + first);
        };
        const Doubles centre[3] = {rest(PoseAccess::RestRow::kCentre),
                                   rest(PoseAccess::RestRow::kCentre + 1),
                                   rest(PoseAccess::RestRow::kCentre + 2)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // The joint centre goes where the whole matrix, non-uniform scale included, puts it.
            const Doubles all[3] = {m[0][axis], m[1][axis], m[2][axis]};
            const Doubles turn[3] = {x[axis], y[axis], across[axis]};
            const Doubles offset =
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

/// Of a rotation, with that part found first which is largest.
HWY_INLINE Quaternions quaternionsOf(const Doubles (&m)[3][3]) {
    const DoubleTag d;
    const Doubles one = allOf(1.0), half = allOf(0.5), quarter = allOf(0.25);
    const Doubles xPlusY = hn::Add(m[0][0], m[1][1]), xLessY = hn::Sub(m[0][0], m[1][1]);
    const Doubles forW = hn::Add(xPlusY, m[2][2]), forX = hn::Sub(xLessY, m[2][2]);
    const Doubles forY = hn::Neg(hn::Add(xLessY, m[2][2])), forZ = hn::Sub(m[2][2], xPlusY);
    const Doubles largestAxis = hn::Max(forX, hn::Max(forY, forZ));
    const Doubles largest = hn::Mul(half, hn::Sqrt(hn::Add(hn::Max(forW, largestAxis), one)));
    const Doubles factor = hn::Div(quarter, largest);
    const Doubles lessX = hn::Mul(factor, hn::Sub(m[1][2], m[2][1]));
    const Doubles lessY = hn::Mul(factor, hn::Sub(m[2][0], m[0][2]));
    const Doubles lessZ = hn::Mul(factor, hn::Sub(m[0][1], m[1][0]));
    const DoubleMask isW = hn::Ge(forW, largestAxis);
    Quaternions q{largest, lessX, lessY, lessZ};
    if (HWY_LIKELY(hn::AllTrue(d, isW))) return q;
    const Doubles xy = hn::Mul(factor, hn::Add(m[0][1], m[1][0]));
    const Doubles yz = hn::Mul(factor, hn::Add(m[1][2], m[2][1]));
    const Doubles zx = hn::Mul(factor, hn::Add(m[2][0], m[0][2]));
    const DoubleMask isX = hn::Eq(forX, largestAxis), isY = hn::Eq(forY, largestAxis);
    const auto choose = [&](Doubles w, Doubles x, Doubles y, Doubles z) HWY_ATTR {
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

HWY_NOINLINE void splitAlone(const PoseCall& call, std::size_t first, const double (&q)[4][4],
                             const double* alone, double (&angles)[4][4]) {
    for (std::size_t lane = 0; lane < hn::Lanes(DoubleTag()); ++lane) {
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
    const DoubleTag d;
    const Doubles zero = hn::Zero(d), one = allOf(1.0), two = allOf(2.0);
    const Doubles xyz[3] = {q.x, q.y, q.z};
    const auto along = [&](std::size_t row) HWY_ATTR {
        const double* at = call.rest + row * call.count + first;
        const Doubles axis[3] = {hn::LoadU(d, at), hn::LoadU(d, at + call.count),
                                 hn::LoadU(d, at + 2 * call.count)};
        return dot(xyz, axis);
    };
    // c + s w is the twist, u1 e1 + u2 e2 what is perpendicular to w; of q and -q the one where c
    // is positive.
    const Doubles sign = hn::And(q.w, hn::SignBit(d));
    const Doubles c = hn::Xor(q.w, sign);
    const Doubles s = hn::Xor(along(PoseAccess::RestRow::kPole), sign);
    const Doubles u1 = hn::Xor(along(PoseAccess::RestRow::kE1), sign);
    const Doubles u2 = hn::Xor(along(PoseAccess::RestRow::kE2), sign);
    const Doubles cosine = hn::Sqrt(hn::MulAdd(c, c, hn::Mul(s, s)));
    const Doubles sine = hn::Sqrt(hn::MulAdd(u1, u1, hn::Mul(u2, u2)));
    const DoubleMask bends = hn::Ge(sine, allOf(kNoBend));
    Angles angles;
    angles.bend = hn::IfThenElseZero(bends, hn::Mul(two, angleOf(sine, cosine)));
    angles.twist = hn::Mul(two, angleOf(s, c));
    // q times the inverse twist: eq. 3.
    const Doubles length = hn::Div(one, hn::Mul(sine, cosine));
    angles.cosine = hn::Mul(hn::MulSub(c, u1, hn::Mul(s, u2)), length);
    angles.sine = hn::Mul(hn::MulAdd(c, u2, hn::Mul(s, u1)), length);
    angles.cosine = hn::IfThenElse(bends, angles.cosine, one);
    angles.sine = hn::IfThenElseZero(bends, angles.sine);
    const DoubleMask alone = hn::Or(hn::Eq(c, zero), hn::Lt(cosine, allOf(kHalfTurn)));
    if (HWY_LIKELY(hn::AllFalse(d, alone))) return angles;
    double quaternions[4][4], all[4][4], which[4];
    Doubles* const parts[4] = {&angles.bend, &angles.twist, &angles.cosine, &angles.sine};
    const Doubles* const from[4] = {&q.w, &q.x, &q.y, &q.z};
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
HWY_INLINE Doubles continued(const Doubles& before, const Doubles& twist) {
    const Doubles turn = allOf(6.283185307179586477), near = allOf(0.25 * 6.283185307179586477);
    Doubles result = twist;
    const auto choose = [&](const Doubles& angle) HWY_ATTR {
        const DoubleMask good =
            hn::And(hn::Lt(hn::Abs(angle), turn), hn::Le(hn::Abs(hn::Sub(angle, before)), near));
        result = hn::IfThenElse(good, angle, result);
    };
    // The first that is good is to be taken, so it comes last.
    choose(hn::Sub(twist, turn));
    choose(hn::Add(twist, turn));
    choose(twist);
    return result;
}

/// Writes joints of a pose; returns where they are others than before.
HWY_INLINE DoubleMask write(const PoseCall& call, std::size_t first, const Quaternions& q,
                            const Doubles (&offset)[3], const Doubles& scale) {
    using Access = PoseAccess::Row;
    const DoubleTag d;
    const hn::Rebind<std::int32_t, DoubleTag> steps;
    double* const at = call.rows + first;
    Angles angles = split(call, first, q);
    if (HWY_UNLIKELY(call.continued))
        angles.twist = continued(hn::LoadU(d, at + Access::kTwist * call.count), angles.twist);
    DoubleMask other = hn::Ne(angles.twist, hn::LoadU(d, at + Access::kTwist * call.count));
    const auto put = [&](std::size_t row, const Doubles& value) HWY_ATTR {
        double* const to = at + row * call.count;
        other = hn::Or(other, hn::Ne(value, hn::LoadU(d, to)));
        hn::StoreU(value, d, to);
    };
    put(Access::kW, q.w);
    put(Access::kX, q.x);
    put(Access::kY, q.y);
    put(Access::kZ, q.z);
    for (std::size_t axis = 0; axis < 3; ++axis) put(Access::kOffset + axis, offset[axis]);
    put(Access::kScale, scale);
    hn::StoreU(angles.bend, d, at + Access::kBend * call.count);
    hn::StoreU(angles.twist, d, at + Access::kTwist * call.count);
    // As good as the kernel's floats, in half of a double's room.
    const auto inSteps = [&](const Doubles& x) HWY_ATTR {
        const Doubles of = hn::Mul(x, allOf(1.0 / PoseAccess::kAzimuthStep));
        return hn::DemoteTo(steps, hn::Add(of, hn::CopySign(allOf(0.5), of)));
    };
    // Read and written as vectors and bytes only, which may be anything.
    auto* const azimuths =
        reinterpret_cast<std::int32_t*>(call.rows + Access::kAzimuth * call.count);
    hn::StoreU(inSteps(angles.cosine), steps, azimuths + first);
    hn::StoreU(inSteps(angles.sine), steps, azimuths + call.count + first);
    return other;
}

bool splitFrames(const PoseCall& call, const PoseFrames& frames) {
    const DoubleTag d;
    const Doubles one = allOf(1.0);
    DoubleMask other = hn::Lt(one, one);
    for (std::size_t next = 0; next < call.count; next += hn::Lanes(d)) {
        const std::size_t first = HWY_MIN(next, call.count - hn::Lanes(d)); // the last ones overlap
        const int* parents = call.parents + first;
        const auto own = [&](std::size_t row) HWY_ATTR {
            return hn::LoadU(d, frames.rows + row * frames.stride + first);
        };
        const auto above = [&](std::size_t row) HWY_ATTR {
            return loadEach(frames.rows + row * frames.stride, parents);
        };
        Doubles turn[3][3], offset[3], shift[3];
        const Doubles turned[3][3] = {
            {own(0), own(1), own(2)}, {own(3), own(4), own(5)}, {own(6), own(7), own(8)}};
        for (std::size_t axis = 0; axis < 3; ++axis)
            shift[axis] = hn::Sub(own(9 + axis), above(9 + axis));
        for (std::size_t row = 0; row < 3; ++row) {
            const Doubles back[3] = {above(3 * row), above(3 * row + 1), above(3 * row + 2)};
            for (std::size_t column = 0; column < 3; ++column)
                turn[column][row] = dot(back, turned[column]);
            offset[row] = dot(back, shift);
        }
        Doubles scale = own(12);
        const Doubles before = above(12);
        if (HWY_UNLIKELY(!hn::AllTrue(d, hn::And(hn::Eq(scale, one), hn::Eq(before, one))))) {
            for (Doubles& axis : offset) axis = hn::Div(axis, before);
            scale = hn::Div(scale, before);
            scale = hn::IfThenElse(hn::Lt(hn::Abs(hn::Sub(scale, one)), allOf(1e-6)), one, scale);
        }
        other = hn::Or(other, write(call, first, quaternionsOf(turn), offset, scale));
    }
    return !hn::AllFalse(d, other);
}

bool splitMaps(const PoseCall& call, const JointMap* own) {
    static_assert(isPacked<JointMap, double, 8>() && offsetof(JointMap, offset) == 32);
    const DoubleTag d;
    DoubleMask other = hn::Lt(allOf(1.0), allOf(1.0));
    for (std::size_t next = 0; next < call.count; next += hn::Lanes(d)) {
        const std::size_t first = HWY_MIN(next, call.count - hn::Lanes(d)); // the last ones overlap
        const double* from[4];
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
            from[lane] = reinterpret_cast<const double*>(&own[first + lane].rotation.x);
        Doubles q[4], rest[4]; // x, y, z, w
        loadFour(from, 0, q);
        loadFour(from, 4, rest);
        const Doubles offset[3] = {rest[0], rest[1], rest[2]};
        other = hn::Or(other, write(call, first, {q[3], q[0], q[1], q[2]}, offset, rest[3]));
    }
    return !hn::AllFalse(d, other);
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
