// SPDX-License-Identifier: MIT
//
// Included by ChainKernel.cpp once for each instruction set.
#if defined(OSGSKIN_CHAINSTATES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_CHAINSTATES_INL_H
#undef OSGSKIN_CHAINSTATES_INL_H
#else
#define OSGSKIN_CHAINSTATES_INL_H
#endif

#include <hwy/highway.h>

#include "chains/ChainJoints-inl.h"

#include <glm/gtc/quaternion.hpp>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// A full turn of a joint of the section.
struct RowsTurn {
    const double* turns; ///< as PosedChains::turns
    const double* offset;
    std::size_t stride;

    double turn(std::size_t column, std::size_t row) const {
        return turns[(3 * column + row) * ChainPlan::kMostJoints];
    }
    double move(std::size_t row) const { return offset[row * stride]; }
    double scale() const {
        return offset[(PoseAccess::Row::kScale - PoseAccess::Row::kOffset) * stride];
    }
};

/// Of one that the section has no room for.
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

/// First `with`, then `from`.
///
/// \param about where moves in single precision are told of
/// \param narrowed the same in single precision, so told; may be null
/// \param lead the same as it is; may be null
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

/// First `with`, which does not scale, and is moved by `move` instead of its own; then `from`.
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
