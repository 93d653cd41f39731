// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, through foreach_target.h; the best is chosen at run time.
#include "pose/CorrectiveWeights.h"

#include "model/SkinBlocks.h"
#include "pose/PoseKernel.h"

#include <cmath>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pose/CorrectiveWeights.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using ModeTag = hn::CappedTag<double, CorrectiveTable::kAtOnce>;

void sumTerms(const WeightTerms& of, double* beta) {
    const ModeTag d;
    constexpr std::size_t kLanes = hn::MaxLanes(ModeTag());
    const auto sum = [&](std::size_t first, auto vectors) HWY_ATTR {
        constexpr std::size_t kVectors = decltype(vectors)::value;
        hn::Vec<ModeTag> sums[kVectors];
        for (auto& each : sums) each = hn::Zero(d);
        for (std::size_t i = 0; i < of.count; ++i) {
            const WeightTerms::Term& term = of.terms[i];
            const auto factor = hn::Set(d, term.factor);
            for (std::size_t k = 0; k < kVectors; ++k)
                sums[k] = hn::MulAdd(factor, hn::LoadU(d, term.coefficients + first + k * kLanes),
                                     sums[k]);
        }
        for (std::size_t k = 0; k < kVectors; ++k)
            hn::StoreU(sums[k], d, beta + first + k * kLanes);
    };
    std::size_t first = 0;
    for (; first + 3 * kLanes <= of.modes; first += 3 * kLanes)
        sum(first, std::integral_constant<std::size_t, 3>());
    for (; first < of.modes; first += kLanes) sum(first, std::integral_constant<std::size_t, 1>());
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(sumTerms);

WeightTerms::WeightTerms(const CorrectiveJoint& joint, const CorrectiveTable& table,
                         glm::dvec2 xy) noexcept
    : modes(table.stride) {
    const glm::dvec2 at = joint.clamped(xy);
    const double x = at.x, y = at.y;
    double splines[3];
    switch (joint.basis) {
    case CorrectiveJoint::Basis::Hinge: {
        const std::size_t first = splinesAt(joint.knots, x, splines);
        for (std::size_t i = 0; i < 3; ++i) add(splines[i], table.row(first + i));
        add(-1.0, table.row(table.restRow));
        add(y, table.row(table.restRow - 3));
        add(x * y, table.row(table.restRow - 2));
        add(y * y, table.row(table.restRow - 1));
        return;
    }
    case CorrectiveJoint::Basis::TurnedHinge: {
        const std::size_t first = splinesAt(joint.knots, x, splines);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t row = 3 * (first + i);
            add(splines[i], table.row(row));
            add(splines[i] * y, table.row(row + 1));
            add(splines[i] * y * y, table.row(row + 2));
        }
        add(-1.0, table.row(table.restRow));
        return;
    }
    case CorrectiveJoint::Basis::Ball: {
        const double all[] = {x,         y,         x * x,     x * y,    y * y,
                              x * x * x, x * x * y, x * y * y, y * y * y};
        for (std::size_t i = 0; i < 9; ++i) add(all[i], table.row(i));
        return;
    }
    case CorrectiveJoint::Basis::Round: {
        const double all[] = {1.0,
                              x,
                              y,
                              x * x - y * y,
                              2.0 * x * y,
                              x * (x * x - 3.0 * y * y),
                              y * (3.0 * x * x - y * y)};
        const std::size_t first = splinesAt(joint.knots, x * x + y * y, splines);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t n = 0; n < 7; ++n)
                add(splines[i] * all[n], table.row(7 * (first + i) + n));
        add(-1.0, table.row(table.restRow));
        return;
    }
    case CorrectiveJoint::Basis::Input:
        add(x, table.row(0));
        return;
    }
}

void WeightTerms::sum(double* beta) const noexcept {
    HWY_DYNAMIC_DISPATCH(sumTerms)(*this, beta);
}

glm::dvec2 CorrectiveWeights::coordinatesOf(std::uint32_t joint) const noexcept {
    const CorrectiveJoint& of = _blocks->joints[joint];
    if (of.basis == CorrectiveJoint::Basis::Input) return {double(_pose.input(of.joint)), 0.0};
    const PoseAccess::Split split = PoseAccess::split(_pose, of.joint);
    const glm::dvec2 axis(split.azimuthCosine, split.azimuthSine);
    return std::sin(0.5 * split.bendAngle) * PoseAccess::kAzimuthStep *
           (_blocks->tables[joint].toAxes * axis);
}

void CorrectiveWeights::workOut(std::uint32_t joint) noexcept {
    const CorrectiveJoint& from = _blocks->joints[joint];
    static_assert(CorrectiveJoint::kMaxModes % CorrectiveTable::kAtOnce == 0);
    double beta[CorrectiveJoint::kMaxModes];
    WeightTerms(from, _blocks->tables[joint], coordinatesOf(joint)).sum(beta);
    const double small = SkinModelAccess::blocks(_model).smallMove;
    Weights& weights = _weights[joint];
    bool isSomething = false;
    for (std::size_t k = 0; k < from.modes; ++k) {
        // Rounding errors of a rest pose read from matrices have no effect.
        isSomething |= std::abs(beta[k]) > small;
        const double unit = beta[k] / Correctives::kUnit;
        weights.positions[k] = static_cast<float>(unit);
        weights.normals[k] =
            static_cast<float>(_blocks->hasNormals ? unit * from.normalScales[k] : 0.0);
    }
    _states[joint] = State::Known;
    _known[joint] = isSomething ? &weights : nullptr;
}

} // namespace osgSkin
#endif
