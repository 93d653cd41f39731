// SPDX-License-Identifier: MIT
//
// Included by PosedChains.cpp once for each instruction set.
#if defined(OSGSKIN_CHAINSTATES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_CHAINSTATES_INL_H
#undef OSGSKIN_CHAINSTATES_INL_H
#else
#define OSGSKIN_CHAINSTATES_INL_H
#endif

#include <hwy/highway.h>

#include "core/Doubles-inl.h"
#include "deform/PosedChains.h"
#include "pose/PoseKernel.h"

#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// One number of each of up to eight joints.
constexpr std::size_t kAtOnce = 8;
using JointTag = hn::CappedTag<double, kAtOnce>;
using Joints = hn::Vec<JointTag>;
using JointMask = hn::Mask<JointTag>;
using JointFloats = hn::Rebind<float, JointTag>;
using JointSteps = hn::Rebind<std::int32_t, JointTag>;

HWY_INLINE Joints each(double x) {
    return hn::Set(JointTag(), x);
}

/// The last column of a map without translation.
alignas(16) constexpr float kNoMove[4] = {0.0f, 0.0f, 0.0f, 1.0f};

/// Rounding errors become 0: their products would be denormal numbers, which are many times slower.
template <typename V, typename T>
HWY_INLINE V flushed(const V& x, T least) {
    return hn::IfThenElseZero(hn::Ge(hn::Abs(x), hn::Set(hn::DFromV<V>(), least)), x);
}

/// The rows of a pose, or gathered from it.
struct JointRows {
    const double* own;  ///< by PoseAccess::Row
    const double* rest; ///< by PoseAccess::RestRow
    const std::int32_t* azimuths;
    const int* parents;
    std::size_t stride;

    HWY_INLINE Joints ownOf(std::size_t row, std::size_t first) const {
        return hn::LoadU(JointTag(), own + row * stride + first);
    }
    HWY_INLINE Joints restOf(std::size_t row, std::size_t first) const {
        return hn::LoadU(JointTag(), rest + row * stride + first);
    }
};

HWY_INLINE JointRows rowsOf(const Pose& pose) {
    const double* const rows = PoseAccess::rows(pose);
    return {rows, PoseAccess::restRows(pose), PoseAccess::azimuths(rows, pose.size()),
            PoseAccess::parents(pose), pose.size()};
}

/// Memory for a section's gathered rows.
struct GatheredRows {
    double own[PoseAccess::kNumberRows * ChainPlan::kMaxJoints];
    double rest[PoseAccess::kRestRows * ChainPlan::kMaxJoints];
    std::int32_t azimuths[2 * ChainPlan::kMaxJoints];
    int parents[ChainPlan::kMaxJoints];
};

/// Stores angles and what KernelAngle has of them.
HWY_INLINE void putAngle(const Joints& whole, float* wholes, float* angles, std::int32_t* ranges) {
    const JointFloats d;
    const JointSteps steps;
    const auto angle = hn::DemoteTo(d, flushed(whole, 1e-9));
    const auto size = hn::Abs(angle);
    const auto beyond = [&](float end) HWY_ATTR { return hn::Gt(size, hn::Set(d, end)); };
    const auto large = beyond(1.5708f), larger = beyond(3.1416f);
    const auto one = hn::Set(steps, 1);
    auto range = hn::Zero(steps);
    for (const auto& end : {beyond(0.34f), beyond(0.9f), large, larger})
        range = hn::Add(range, hn::IfThenElseZero(hn::RebindMask(steps, end), one));
    auto part = hn::IfThenElse(large, hn::Set(d, 0.5f), hn::Set(d, 1.0f));
    part = hn::IfThenElse(larger, hn::Set(d, 0.25f), part);
    hn::StoreU(angle, d, wholes);
    hn::StoreU(hn::Mul(angle, part), d, angles);
    hn::StoreU(range, steps, ranges);
}

/// The joints' translations; of the root, its offset.
HWY_INLINE void movesOf(const JointRows& rows, std::size_t first, const Joints (&turn)[3][3],
                        Joints (&move)[3]) {
    const JointTag d;
    const Joints centre[3] = {rows.restOf(PoseAccess::RestRow::kCentre, first),
                              rows.restOf(PoseAccess::RestRow::kCentre + 1, first),
                              rows.restOf(PoseAccess::RestRow::kCentre + 2, first)};
    const Joints parents = hn::PromoteTo(d, hn::LoadU(JointSteps(), rows.parents + first));
    const Joints from = hn::IfThenElseZero(hn::Ge(parents, hn::Zero(d)), each(1.0));
    const Joints scale = rows.ownOf(PoseAccess::Row::kScale, first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Joints row[3] = {turn[0][axis], turn[1][axis], turn[2][axis]};
        const Joints turned = hn::MulSub(scale, dot(row, centre), centre[axis]);
        move[axis] = hn::MulAdd(from, turned, rows.ownOf(PoseAccess::Row::kOffset + axis, first));
    }
}

/// Computes the KernelJoints, but for translations and scales, and full rotations from `first` on.
HWY_INLINE void poseJoints(const JointRows& rows, std::size_t first, const ChainCall& call,
                           PosedChains& chains, JointMask& adjusted, JointMask& scaled) {
    using Own = PoseAccess::Row;
    const JointTag d;
    const JointFloats floats;
    const JointSteps steps;
    const Joints zero = hn::Zero(d), one = each(1.0);

    // The full rotation.
    const Joints w = rows.ownOf(Own::kW, first), x = rows.ownOf(Own::kX, first),
                 y = rows.ownOf(Own::kY, first), z = rows.ownOf(Own::kZ, first);
    const Joints x2 = hn::Add(x, x), y2 = hn::Add(y, y), z2 = hn::Add(z, z);
    const Joints xx = hn::Mul(x2, x), yy = hn::Mul(y2, y), zz = hn::Mul(z2, z);
    const Joints xy = hn::Mul(x2, y), yz = hn::Mul(y2, z), zx = hn::Mul(z2, x);
    const Joints wx = hn::Mul(x2, w), wy = hn::Mul(y2, w), wz = hn::Mul(z2, w);
    const Joints turn[3][3] = {{hn::Sub(hn::Sub(one, yy), zz), hn::Add(xy, wz), hn::Sub(zx, wy)},
                               {hn::Sub(xy, wz), hn::Sub(hn::Sub(one, xx), zz), hn::Add(yz, wx)},
                               {hn::Add(zx, wy), hn::Sub(yz, wx), hn::Sub(hn::Sub(one, xx), yy)}};
    for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            hn::StoreU(turn[column][row], d, chains.turns[3 * column + row] + first);

    KernelJoints& joints = chains.joints;
    putAngle(rows.ownOf(Own::kBend, first), joints.wholeBend + first, joints.bend + first,
             joints.bendRange + first);
    putAngle(rows.ownOf(Own::kTwist, first), joints.wholeTwist + first, joints.twist + first,
             joints.twistRange + first);
    const auto step = hn::Set(floats, static_cast<float>(PoseAccess::kAzimuthStep));
    const auto azimuth = [&](std::size_t row, float* to) HWY_ATTR {
        const auto whole = hn::LoadU(steps, rows.azimuths + row * rows.stride + first);
        hn::StoreU(hn::Mul(step, hn::ConvertTo(floats, whole)), floats, to + first);
    };
    azimuth(0, joints.azimuthCosine);
    azimuth(1, joints.azimuthSine);

    Joints move[3], square = zero;
    movesOf(rows, first, turn, move);
    for (const Joints& axis : move) square = hn::MulAdd(axis, axis, square);
    const JointMask grows = hn::Ne(rows.ownOf(Own::kScale, first), one);
    const JointMask moves = hn::Gt(square, each(call.smallMove * call.smallMove));
    // The root usually moves, but nothing follows it in part.
    const std::int32_t* const partial = &call.plan.arePartial[call.section.joint + first];
    const JointMask isPartial = hn::Ne(hn::PromoteTo(d, hn::LoadU(steps, partial)), zero);
    const JointMask changed = hn::Or(grows, hn::And(moves, isPartial));
    scaled = hn::Or(scaled, grows);
    adjusted = hn::Or(adjusted, changed);
    hn::StoreU(hn::DemoteTo(steps, hn::IfThenElseZero(changed, one)), steps,
               joints.adjusted + first);
}

/// Computes the translations and scales of joints from `first` on, in their frames.
HWY_INLINE void poseMoves(const JointRows& rows, std::size_t first, PosedChains& chains) {
    using Rest = PoseAccess::RestRow;
    const JointTag d;
    const JointFloats floats;
    Joints turn[3][3], move[3];
    for (std::size_t i = 0; i < 9; ++i) turn[i / 3][i % 3] = hn::LoadU(d, chains.turns[i] + first);
    movesOf(rows, first, turn, move);
    const auto azimuth = [&](std::size_t row) HWY_ATTR {
        const auto whole = hn::LoadU(JointSteps(), rows.azimuths + row * rows.stride + first);
        return hn::Mul(each(PoseAccess::kAzimuthStep), hn::PromoteTo(d, whole));
    };
    const Joints cosine = azimuth(0), sine = azimuth(1);
    Joints along[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}; // e1, e2, w
    for (std::size_t axis = 0; axis < 3; ++axis) {
        along[0] = hn::MulAdd(move[axis], rows.restOf(Rest::kE1 + axis, first), along[0]);
        along[1] = hn::MulAdd(move[axis], rows.restOf(Rest::kE2 + axis, first), along[1]);
        along[2] = hn::MulAdd(move[axis], rows.restOf(Rest::kPole + axis, first), along[2]);
    }
    KernelJoints& joints = chains.joints;
    const auto put = [&](const Joints& value, float* row) HWY_ATTR {
        hn::StoreU(hn::DemoteTo(floats, flushed(value, 1e-15)), floats, row + first);
    };
    put(hn::Sub(rows.ownOf(PoseAccess::Row::kScale, first), each(1.0)), joints.growth);
    put(hn::MulAdd(cosine, along[0], hn::Mul(sine, along[1])), joints.move[0]);
    put(hn::MulSub(cosine, along[1], hn::Mul(sine, along[0])), joints.move[1]);
    put(along[2], joints.move[2]);
}

/// The full rotation of a joint of the section.
struct RowsTurn {
    const double* turns; ///< as PosedChains::turns
    const double* offset;
    std::size_t stride;

    double turn(std::size_t column, std::size_t row) const {
        return turns[(3 * column + row) * ChainPlan::kMaxJoints];
    }
    double move(std::size_t row) const { return offset[row * stride]; }
    double scale() const {
        return offset[(PoseAccess::Row::kScale - PoseAccess::Row::kOffset) * stride];
    }
};

/// The full rotation of a joint for which the section has no room.
struct SplitTurn {
    HWY_NOINLINE SplitTurn(const Pose& pose, std::uint32_t joint)
        : split(PoseAccess::split(pose, joint)), rotation(glm::mat3_cast(split.rotation)) {}

    double turn(std::size_t column, std::size_t row) const {
        return rotation[static_cast<int>(column)][static_cast<int>(row)];
    }
    double move(std::size_t row) const { return split.offset[static_cast<int>(row)]; }
    double scale() const { return split.scale; }

    PoseAccess::Split split;
    glm::dmat3 rotation;
};

/// Multiplies: first `with`, then `from`.
///
/// \param about the pivot of `narrowed`
/// \param narrowed the same in single precision; may be null
/// \param lead the same with the origin as pivot; may be null
template <bool kScaled, typename Turn>
HWY_INLINE void multiply(const PosedMap& from, const Turn& with, PosedMap& to,
                         const std::array<double, 3>& about, KernelMap* narrowed, KernelMap* lead) {
    const DoubleTag d;
    const hn::Rebind<float, DoubleTag> floats;
    constexpr std::size_t kParts = 4 / hn::MaxLanes(DoubleTag());
    const double grown = kScaled ? from.column[3][3] : 1.0;
    const double scale = kScaled ? grown * with.scale() : 1.0;
    Doubles product[4][kParts];
    for (std::size_t part = 0; part < kParts; ++part) {
        const auto column = [&](std::size_t i) HWY_ATTR {
            return hn::Load(d, from.column[i] + part * hn::Lanes(d));
        };
        const Doubles x = column(0), y = column(1), z = column(2);
        for (std::size_t i = 0; i < 3; ++i)
            product[i][part] = hn::MulAdd(
                x, allOf(with.turn(i, 0)),
                hn::MulAdd(y, allOf(with.turn(i, 1)), hn::Mul(z, allOf(with.turn(i, 2)))));
        product[3][part] =
            hn::MulAdd(x, allOf(grown * with.move(0)),
                       hn::MulAdd(y, allOf(grown * with.move(1)),
                                  hn::MulAdd(z, allOf(grown * with.move(2)), column(3))));
    }
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t part = 0; part < kParts; ++part)
            hn::Store(product[i][part], d, to.column[i] + part * hn::Lanes(d));
    if (kScaled) to.column[3][3] = scale;
    const auto narrow = [&](std::size_t i, std::size_t part, const Doubles& numbers, KernelMap& map)
                            HWY_ATTR {
                                hn::StoreU(hn::DemoteTo(floats, flushed(numbers, 1e-15)), floats,
                                           map.column[i] + part * hn::Lanes(d));
                            };
    const double grows = kScaled ? scale : 1.0;
    for (KernelMap* const map : {narrowed, lead}) {
        if (!map) continue;
        for (std::size_t part = 0; part < kParts; ++part) {
            for (std::size_t i = 0; i < 3; ++i) narrow(i, part, product[i][part], *map);
            Doubles move = product[3][part];
            if (map == narrowed)
                for (std::size_t i = 0; i < 3; ++i)
                    move = hn::MulAdd(product[i][part], allOf(grows * about[i]), move);
            narrow(3, part, move, *map);
        }
        if (kScaled) map->column[3][3] = static_cast<float>(scale);
    }
}

template <bool kScaled>
HWY_INLINE void makeStates(const ChainCall& call, const JointRows& rows, PosedChains& chains) {
    const ChainPlan::State* const states = call.plan.states.data() + call.section.state;
    const std::size_t count = (&call.section)[1].state - call.section.state;
    for (std::size_t i = 0; i < count; ++i) {
        if (call.needed && !call.needed->states[i]) continue;
        const ChainPlan::State& state = states[i];
        const PosedMap& from = chains.wide[state.from];
        PosedMap& to = chains.wide[state.to];
        const auto mapOf = [&](ChainPlan::Index map) {
            return map == ChainPlan::kIdentity ? nullptr : &chains.maps[map];
        };
        KernelMap* const narrowed = mapOf(state.narrowed);
        KernelMap* const lead = mapOf(state.narrowedLead);
        if (HWY_UNLIKELY(state.joint & ChainPlan::kUncached))
            multiply<kScaled>(from, SplitTurn(call.pose, state.joint & ~ChainPlan::kUncached), to,
                              state.about, narrowed, lead);
        else
            multiply<kScaled>(
                from,
                RowsTurn{chains.turns[0] + state.joint,
                         rows.own + PoseAccess::Row::kOffset * rows.stride + state.joint,
                         rows.stride},
                to, state.about, narrowed, lead);
    }
}

/// Multiplies: first `with`, which does not scale, with `move4` as its last column; then `from`.
HWY_INLINE void multiply(const KernelMap& from, const KernelMap& with, const float* move4,
                         KernelMap& to) {
    const hn::CappedTag<float, 16> d;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 16; ++i) {
        const float* const column = i < 12 ? with.column[i / 4] : move4;
        auto sum = hn::Set(d, from.column[3][i % 4] * column[3]);
        for (std::size_t k = 3; k-- > 0;)
            sum = hn::MulAdd(hn::Set(d, from.column[k][i % 4]), hn::Set(d, column[k]), sum);
        hn::Store(flushed(sum, 1e-15f), d, to.column[i / 4] + i % 4);
    }
#else
    const auto x = hn::LoadDup128(d, from.column[0]), y = hn::LoadDup128(d, from.column[1]),
               z = hn::LoadDup128(d, from.column[2]), move = hn::LoadDup128(d, from.column[3]),
               start = hn::LoadDup128(d, move4);
    for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        const auto isTurn = hn::FirstN(d, HWY_MAX(i, std::size_t{12}) - i);
        const auto columns = hn::IfThenElse(isTurn, hn::Load(d, with.column[0] + i), start);
        auto sum = hn::Mul(move, hn::Broadcast<3>(columns)); // only the last column has that
        sum = hn::MulAdd(z, hn::Broadcast<2>(columns), sum);
        sum = hn::MulAdd(y, hn::Broadcast<1>(columns), sum);
        sum = hn::MulAdd(x, hn::Broadcast<0>(columns), sum);
        hn::Store(flushed(sum, 1e-15f), d, to.column[0] + i);
    }
#endif
}

template <bool kScaled>
HWY_INLINE void makeOuts(const ChainCall& call, PosedChains& chains) {
    const ChainPlan::Out* const outs = call.plan.outs.data() + call.section.out;
    const std::size_t count = (&call.section)[1].out - call.section.out;
    for (std::size_t i = 0; i < count; ++i) {
        if (call.needed && !call.needed->outs[i]) continue;
        const KernelMap& from = chains.maps[outs[i].from];
        const KernelMap& with = chains.maps[outs[i].with];
        if (!kScaled) {
            multiply(from, with, outs[i].move, chains.outs[i]);
            continue;
        }
        alignas(16) float scaled[4] = {outs[i].move[0], outs[i].move[1], outs[i].move[2], 1.0f};
        for (std::size_t axis = 0; axis < 3; ++axis) scaled[axis] *= from.scale();
        multiply(from, with, scaled, chains.outs[i]);
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
