// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set by foreach_target.h, which includes this file again and
// again; the best one is chosen at run time.
#include "chains/ChainKernel.h"

#include "pose/PoseAccess.h"

#include <glm/gtc/quaternion.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chains/ChainKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "points/Doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

using FloatTag = hn::Rebind<float, DoubleTag>;
using StepTag = hn::Rebind<std::int32_t, DoubleTag>;

/// Rounding errors are taken as 0: their products would be denormal numbers, which processors are
/// many times slower with.
HWY_INLINE Doubles flushed(const Doubles& x, double least) {
    return hn::IfThenElseZero(hn::Ge(hn::Abs(x), allOf(least)), x);
}

/// Rows of a pose's joints, as they stand in it or gathered.
struct JointRows {
    const double* own;  ///< by PoseAccess::Row
    const double* rest; ///< by PoseAccess::RestRow
    const std::int32_t* azimuths;
    const int* parents;
    std::size_t stride;
};

HWY_INLINE JointRows rowsOf(const Pose& pose) {
    const double* const rows = PoseAccess::rows(pose);
    return {rows, PoseAccess::restRows(pose), PoseAccess::azimuths(rows, pose.size()),
            PoseAccess::parents(pose), pose.size()};
}

/// Where rows of a section's own are put together.
struct GatheredRows {
    double own[PoseAccess::kNumberRows * ChainPlan::kMostJoints];
    double rest[PoseAccess::kRestRows * ChainPlan::kMostJoints];
    std::int32_t azimuths[2 * ChainPlan::kMostJoints];
    int parents[ChainPlan::kMostJoints];
};

/// Of `lanes` joints: which of the ranges that its sine is known in an angle is in, and the angle
/// as it is told there.
HWY_INLINE void putAngle(const Doubles& whole, float* angles, std::int32_t* ranges) {
    const DoubleTag d;
    const FloatTag floats;
    const StepTag steps;
    const Doubles angle = flushed(whole, 1e-9), size = hn::Abs(angle);
    const Doubles one = allOf(1.0);
    Doubles range = hn::Zero(d);
    for (const double end : {0.34, 0.9, 1.5708, 3.1416})
        range = hn::Add(range, hn::IfThenElseZero(hn::Gt(size, allOf(end)), one));
    Doubles part = hn::IfThenElse(hn::Gt(size, allOf(1.5708)), allOf(0.5), one);
    part = hn::IfThenElse(hn::Gt(size, allOf(3.1416)), allOf(0.25), part);
    hn::StoreU(hn::DemoteTo(floats, hn::Mul(angle, part)), floats, angles);
    hn::StoreU(hn::DemoteTo(steps, range), steps, ranges);
}

/// What joints from `first` on give in any chain.
HWY_INLINE void poseJoints(const JointRows& rows, std::size_t first, double smallMove,
                           PosedChains& chains, DoubleMask& adjusted, DoubleMask& scaled) {
    using Own = PoseAccess::Row;
    using Rest = PoseAccess::RestRow;
    const DoubleTag d;
    const FloatTag floats;
    const StepTag steps;
    const Doubles zero = hn::Zero(d), one = allOf(1.0), two = allOf(2.0);
    const auto own = [&](std::size_t row)
                         HWY_ATTR { return hn::LoadU(d, rows.own + row * rows.stride + first); };
    const auto rest = [&](std::size_t row)
                          HWY_ATTR { return hn::LoadU(d, rows.rest + row * rows.stride + first); };
    PosedMap* const maps = &chains.maps[ChainPlan::full(first)]; // full, frame, into
    constexpr std::size_t kNext = 3 * sizeof(PosedMap) / sizeof(double);
    const auto put4 = [&](std::size_t map, std::size_t column, const Doubles& a, const Doubles& b,
                          const Doubles& c, const Doubles& e)
                          HWY_ATTR { storeFour(a, b, c, e, maps[map].column[column], kNext); };

    // The whole turn.
    const Doubles w = own(Own::kW), x = own(Own::kX), y = own(Own::kY), z = own(Own::kZ);
    const Doubles x2 = hn::Mul(two, x), y2 = hn::Mul(two, y), z2 = hn::Mul(two, z);
    const Doubles xx = hn::Mul(x2, x), yy = hn::Mul(y2, y), zz = hn::Mul(z2, z);
    const Doubles xy = hn::Mul(x2, y), yz = hn::Mul(y2, z), zx = hn::Mul(z2, x);
    const Doubles wx = hn::Mul(x2, w), wy = hn::Mul(y2, w), wz = hn::Mul(z2, w);
    const Doubles turn[3][3] = {{hn::Sub(hn::Sub(one, yy), zz), hn::Add(xy, wz), hn::Sub(zx, wy)},
                                {hn::Sub(xy, wz), hn::Sub(hn::Sub(one, xx), zz), hn::Add(yz, wx)},
                                {hn::Add(zx, wy), hn::Sub(yz, wx), hn::Sub(hn::Sub(one, xx), yy)}};
    const Doubles offset[3] = {own(Own::kOffset), own(Own::kOffset + 1), own(Own::kOffset + 2)};
    const Doubles scale = own(Own::kScale);
    for (std::size_t column = 0; column < 3; ++column)
        put4(0, column, turn[column][0], turn[column][1], turn[column][2], zero);
    put4(0, 3, offset[0], offset[1], offset[2], scale);

    // The frame v, w x v, w about the joint centre, and the way back into it.
    const Doubles step = allOf(PoseAccess::kAzimuthStep);
    const auto azimuth = [&](std::size_t row) HWY_ATTR {
        return hn::Mul(step, hn::PromoteTo(d, hn::LoadU(steps, rows.azimuths + row + first)));
    };
    const Doubles cosine = azimuth(0), sine = azimuth(rows.stride);
    Doubles frame[3][3], centre[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Doubles e1 = rest(Rest::kE1 + axis), e2 = rest(Rest::kE2 + axis);
        frame[0][axis] = hn::MulAdd(cosine, e1, hn::Mul(sine, e2));
        frame[1][axis] = hn::MulSub(cosine, e2, hn::Mul(sine, e1));
        frame[2][axis] = rest(Rest::kPole + axis);
        centre[axis] = rest(Rest::kCentre + axis);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        put4(1, axis, frame[axis][0], frame[axis][1], frame[axis][2], zero);
        put4(2, axis, frame[0][axis], frame[1][axis], frame[2][axis], zero);
    }
    put4(1, 3, centre[0], centre[1], centre[2], one);
    put4(2, 3, hn::Neg(dot(frame[0], centre)), hn::Neg(dot(frame[1], centre)),
         hn::Neg(dot(frame[2], centre)), one);

    KernelJoints& joints = chains.joints;
    putAngle(own(Own::kBend), joints.bend + first, joints.bendRange + first);
    putAngle(own(Own::kTwist), joints.twist + first, joints.twistRange + first);
    const auto put = [&](const Doubles& value, float* row) HWY_ATTR {
        hn::StoreU(hn::DemoteTo(floats, flushed(value, 1e-15)), floats, row + first);
    };
    put(cosine, joints.azimuthCosine);
    put(sine, joints.azimuthSine);

    // Where the joint is moved; the root's centre has nothing to be moved against.
    const Doubles parents = hn::PromoteTo(d, hn::LoadU(steps, rows.parents + first));
    const Doubles from = hn::IfThenElseZero(hn::Ge(parents, zero), one);
    Doubles move[3], square = zero;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Doubles row[3] = {turn[0][axis], turn[1][axis], turn[2][axis]};
        const Doubles turned = hn::MulSub(scale, dot(row, centre), centre[axis]);
        move[axis] = hn::MulAdd(from, turned, offset[axis]);
        square = hn::MulAdd(move[axis], move[axis], square);
    }
    const DoubleMask grows = hn::Ne(scale, one);
    const DoubleMask changed = hn::Or(grows, hn::Gt(square, allOf(smallMove * smallMove)));
    scaled = hn::Or(scaled, grows);
    adjusted = hn::Or(adjusted, changed);
    hn::StoreU(hn::DemoteTo(steps, hn::IfThenElseZero(changed, one)), steps,
               joints.adjusted + first);
    put(hn::Sub(scale, one), joints.growth);
    for (std::size_t axis = 0; axis < 3; ++axis) put(dot(move, frame[axis]), joints.move[axis]);
}

/// Of one that the section has no room for.
HWY_NOINLINE void poseFull(const Pose& pose, std::uint32_t joint, PosedMap& map) {
    const PoseAccess::Split split = PoseAccess::split(pose, joint);
    const glm::dmat3 turn = glm::mat3_cast(split.rotation);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) map.column[column][row] = turn[column][row];
        map.column[column][3] = 0.0;
        map.column[3][column] = split.offset[column];
    }
    map.column[3][3] = split.scale;
}

/// First `with`, then `from`.
template <bool kScaled>
HWY_INLINE void multiplyHalf(const PosedMap& from, const PosedMap& with, std::size_t half,
                             Doubles (&to)[4]) {
    const DoubleTag d;
    const Doubles x = hn::Load(d, from.column[0] + half), y = hn::Load(d, from.column[1] + half),
                  z = hn::Load(d, from.column[2] + half);
    const auto turned = [&](const double* column) HWY_ATTR {
        return hn::MulAdd(z, allOf(column[2]),
                          hn::MulAdd(y, allOf(column[1]), hn::Mul(x, allOf(column[0]))));
    };
    for (std::size_t column = 0; column < 3; ++column) to[column] = turned(with.column[column]);
    Doubles move = turned(with.column[3]);
    if (kScaled) move = hn::Mul(move, allOf(from.column[3][3]));
    to[3] = hn::Add(move, hn::Load(d, from.column[3] + half));
}

template <bool kScaled>
HWY_INLINE void take(const ChainCall& call, const ChainPlan::Step& step, PosedChains& chains) {
    const DoubleTag d;
    const FloatTag floats;
    const PosedMap* with = &chains.maps[step.with & ~ChainPlan::kUncached];
    PosedMap uncached;
    if (HWY_UNLIKELY(step.with & ChainPlan::kUncached)) {
        poseFull(call.pose, step.with & ~ChainPlan::kUncached, uncached);
        with = &uncached;
    }
    const PosedMap& from = chains.maps[step.from];
    constexpr std::size_t kHalves = 4 / hn::MaxLanes(DoubleTag());
    Doubles product[kHalves][4];
    for (std::size_t half = 0; half < kHalves; ++half)
        multiplyHalf<kScaled>(from, *with, half * hn::Lanes(d), product[half]);
    if (step.isOut) {
        KernelMap& out = chains.outs[step.to];
        for (std::size_t half = 0; half < kHalves; ++half)
            for (std::size_t column = 0; column < 4; ++column)
                hn::StoreU(hn::DemoteTo(floats, flushed(product[half][column], 1e-15)), floats,
                           out.column[column] + half * hn::Lanes(d));
        return;
    }
    const double scale = kScaled ? from.column[3][3] * with->column[3][3] : 1.0;
    PosedMap& to = chains.maps[step.to];
    for (std::size_t half = 0; half < kHalves; ++half)
        for (std::size_t column = 0; column < 4; ++column)
            hn::Store(product[half][column], d, to.column[column] + half * hn::Lanes(d));
    if (kScaled) to.column[3][3] = scale;
}

template <bool kScaled>
HWY_INLINE void takeAll(const ChainCall& call, PosedChains& chains) {
    const ChainPlan::Step* const steps = call.plan.steps.data() + call.section.firstStep;
    const std::size_t count = call.section.endStep - call.section.firstStep;
    for (std::size_t i = 0; i < count; ++i)
        if (!call.needed || call.needed[i]) take<kScaled>(call, steps[i], chains);
}

HWY_NOINLINE JointRows gather(const ChainCall& call, GatheredRows& to) {
    constexpr std::size_t kStride = ChainPlan::kMostJoints, kAtOnce = PoseAccess::kAtOnce;
    const JointRows from = rowsOf(call.pose);
    const std::size_t count = call.section.jointCount;
    const std::size_t padded = (count + kAtOnce - 1) / kAtOnce;
    for (std::size_t i = 0; i < padded * kAtOnce; ++i) {
        const std::size_t joint = call.plan.joints[call.section.firstJoint + HWY_MIN(i, count - 1)];
        for (std::size_t row = 0; row < PoseAccess::kNumberRows; ++row)
            to.own[row * kStride + i] = from.own[row * from.stride + joint];
        for (std::size_t row = 0; row < PoseAccess::kRestRows; ++row)
            to.rest[row * kStride + i] = from.rest[row * from.stride + joint];
        for (std::size_t row = 0; row < 2; ++row)
            to.azimuths[row * kStride + i] = from.azimuths[row * from.stride + joint];
        to.parents[i] = from.parents[joint];
    }
    return {to.own, to.rest, to.azimuths, to.parents, kStride};
}

void multiply(const ChainCall& call, PosedChains& chains) {
    const DoubleTag d;
    GatheredRows room;
    const std::size_t count = call.section.jointCount, lanes = hn::Lanes(d);
    const JointRows rows =
        call.plan.inOrder && count >= lanes ? rowsOf(call.pose) : gather(call, room);
    const Doubles one = allOf(1.0);
    DoubleMask adjusted = hn::Lt(one, one), scaled = adjusted;
    for (std::size_t next = 0; next < count; next += lanes) {
        // The last ones overlap those before.
        const std::size_t first = count >= lanes ? HWY_MIN(next, count - lanes) : next;
        poseJoints(rows, first, call.smallMove, chains, adjusted, scaled);
    }
    chains.scaled = !hn::AllFalse(d, scaled);
    chains.joints.anyAdjusted = !hn::AllFalse(d, adjusted);
    PosedMap& identity = chains.maps[ChainPlan::kIdentity];
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            identity.column[column][row] = column == row ? 1.0 : 0.0;
    chains.scaled ? takeAll<true>(call, chains) : takeAll<false>(call, chains);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(multiply);

void multiplyOut(const ChainCall& call, PosedChains& chains) noexcept {
    HWY_DYNAMIC_DISPATCH(multiply)(call, chains);
}

} // namespace osgSkin
#endif
