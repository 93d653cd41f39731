// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, through foreach_target.h; the best is chosen at run time.
#include "pose/PoseKernel.h"

#include <cfloat>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pose/PoseKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "pose/JointSplits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

bool readFrames(const glm::dmat4* skinning, const PoseCall& call, const PoseFrames& frames) {
    const JointTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Joints zero = hn::Zero(d), one = each(1.0), most = each(DBL_MAX);
    const Joints rounding = each(1e-3), farthest = each(kLargestCoordinate);
    JointMask good = hn::Eq(zero, zero);
    const auto require = [&good](const JointMask& that) HWY_ATTR { good = hn::And(good, that); };
    for (std::size_t row = 0; row < kFrameRows; ++row) // the identity
        *(frames.rows + row * frames.stride - 1) = row == 0 || row == 4 || row == 8 || row == 12;
    for (std::size_t next = 0; next < call.count; next += lanes) {
        const std::size_t first = HWY_MIN(next, call.count - lanes); // the last ones overlap
        const double* from[PoseCall::kAtOnce];
        for (std::size_t lane = 0; lane < lanes; ++lane) from[lane] = &skinning[first + lane][0][0];
        Joints m[4][4];
        for (std::size_t column = 0; column < 4; ++column) loadFourOf(from, 4 * column, m[column]);
        // Rejects NaN.
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
            // The joint centre moves as by the whole matrix, non-uniform scale included.
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

/// Stores numbers of joints; returns which of them have changed.
HWY_INLINE JointMask put(const Joints& value, double* to) {
    const JointTag d;
    const JointMask other = hn::Ne(value, hn::LoadU(d, to));
    hn::StoreU(value, d, to);
    return other;
}

/// Stores the joints' maps; returns which of them have changed.
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

/// Splits the joints' rotations; returns which twists have changed. A separate, short loop, so that
/// the roots and divisions of many joints overlap.
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
        // As precise as the kernel's floats, in half the size of a double.
        const auto inSteps = [&](const Joints& x) HWY_ATTR {
            const Joints of = hn::Mul(x, each(1.0 / PoseAccess::kAzimuthStep));
            return hn::DemoteTo(steps, hn::Add(of, hn::CopySign(each(0.5), of)));
        };
        // Accessed as vectors and bytes only, which may alias anything.
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
