// SPDX-License-Identifier: GPL-3.0-or-later
//
// foreach_target.h includes this file once for each instruction set; the best one is chosen at run
// time.
#include "elastic/solid/CellEnergy.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastic/solid/CellEnergy.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace osgSkin::elastic {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, CellBatch::kCells>;
using V = hn::Vec<Tag>;

/// Newton steps to the sum of singular values; from above it converges in three or four.
constexpr int kMaxSteps = 12;
constexpr double kExact = 1e-6; ///< relative: the next step would be far below rounding

HWY_INLINE V all(double x) {
    return hn::Set(Tag(), static_cast<float>(x));
}

/// From values at an edge's ends to those at its two Gauss points, by linear interpolation. The
/// weights are symmetric, so this is also its transpose.
HWY_INLINE void toGauss(V& low, V& high) {
    const V step = hn::Mul(all(CellShape::kLow), hn::Sub(high, low));
    low = hn::Add(low, step);
    high = hn::Sub(high, step);
}

/// A component's derivative along an axis at the Gauss points. It depends only on their positions
/// along the other two axes: these are the bits of its index, the lower axis first.
struct Slopes {
    V at[4];
};

/// Corner at bit `end` of `axis`, and at the two bits of `others` of the other axes.
HWY_INLINE std::size_t cornerAt(std::size_t axis, std::size_t end, std::size_t others) {
    const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    return end << axis | (others & 1u) << first | (others >> 1) << second;
}

/// The index in Slopes of a Gauss point's derivative along an axis.
HWY_INLINE std::size_t slopeOf(std::size_t axis, std::size_t point) {
    const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    return (point >> first & 1u) | (point >> second & 1u) << 1;
}

HWY_INLINE void toGauss(Slopes& slopes) {
    toGauss(slopes.at[0], slopes.at[1]);
    toGauss(slopes.at[2], slopes.at[3]);
    toGauss(slopes.at[0], slopes.at[2]);
    toGauss(slopes.at[1], slopes.at[3]);
}

/// F at a Gauss point and quantities derived from it.
struct GaussPoint {
    V f[3][3], cofactor[3][3], metric[3][3]; ///< metric: C = F^T F
    V jacobian, first, second;               ///< J; I1 and I2 of C
};

HWY_INLINE GaussPoint pointAt(const Slopes (&slopes)[3][3], std::size_t g) {
    GaussPoint p;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) p.f[i][k] = slopes[i][k].at[slopeOf(k, g)];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3,
                              k2 = (k + 2) % 3;
            p.cofactor[i][k] =
                hn::MulSub(p.f[i1][k1], p.f[i2][k2], hn::Mul(p.f[i1][k2], p.f[i2][k1]));
        }
    p.jacobian =
        hn::MulAdd(p.f[0][0], p.cofactor[0][0],
                   hn::MulAdd(p.f[0][1], p.cofactor[0][1], hn::Mul(p.f[0][2], p.cofactor[0][2])));
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = a; b < 3; ++b)
            p.metric[a][b] = p.metric[b][a] =
                hn::MulAdd(p.f[0][a], p.f[0][b],
                           hn::MulAdd(p.f[1][a], p.f[1][b], hn::Mul(p.f[2][a], p.f[2][b])));
    p.first = hn::Add(hn::Add(p.metric[0][0], p.metric[1][1]), p.metric[2][2]);
    // I2 is the sum of the squares of the cofactors.
    p.second = hn::Zero(Tag());
    for (const auto& row : p.cofactor)
        for (const V& entry : row) p.second = hn::MulAdd(entry, entry, p.second);
    return p;
}

/// The sum of singular values, t = tr S of F = R S: the largest root of (t^2 - I1)^2 - 8 J t - 4 I2
/// (Lin, Chitalu & Komura 2022). This needs no decomposition and no branch for single lanes.
HWY_INLINE V traceOf(const GaussPoint& p) {
    const Tag d;
    V trace = hn::Sqrt(hn::Mul(all(3.0), p.first));
    const V eight = hn::Mul(all(8.0), p.jacobian), four = hn::Mul(all(4.0), p.second);
    for (int step = 0; step < kMaxSteps; ++step) {
        const V rest = hn::MulSub(trace, trace, p.first);
        const V value = hn::Sub(hn::MulSub(rest, rest, four), hn::Mul(eight, trace));
        const V slope = hn::MulSub(hn::Mul(all(4.0), trace), rest, eight);
        const V change = hn::Div(value, slope);
        trace = hn::Sub(trace, change);
        if (hn::AllTrue(d, hn::Le(hn::Abs(change), hn::Mul(all(kExact), trace)))) break;
    }
    return trace;
}

/// A Gauss point's energy without the volume term; sets the barrier's derivative by J.
HWY_INLINE V energyAt(const Flesh& flesh, const GaussPoint& p, V trace, V& byJacobian) {
    const Tag d;
    V energy = hn::Add(hn::NegMulAdd(all(2.0), trace, p.first), all(3.0));
    byJacobian = hn::Zero(d);
    const V below = hn::Sub(p.jacobian, all(flesh.barrierBegins));
    const auto acts = hn::Lt(below, hn::Zero(d));
    if (hn::AllFalse(d, acts)) return energy;
    const V ratio = hn::Log(d, hn::Div(p.jacobian, all(flesh.barrierBegins)));
    const V square = hn::Mul(below, below), barrier = all(flesh.barrier);
    energy = hn::Sub(energy, hn::IfThenElseZero(acts, hn::Mul(barrier, hn::Mul(square, ratio))));
    const V slope = hn::MulAdd(hn::Mul(all(2.0), below), ratio, hn::Div(square, p.jacobian));
    byJacobian = hn::IfThenElseZero(acts, hn::Neg(hn::Mul(barrier, slope)));
    return energy;
}

/// Adds dE/dF = 2 (F - R) + dE/dJ cof F to the slopes' gradient, where R, the derivative of the
/// trace by F, is a F + b F C + c cof F.
HWY_INLINE void addStress(const GaussPoint& p, V trace, V byJacobian, std::size_t g,
                          Slopes (&stress)[3][3]) {
    const V square = hn::Mul(trace, trace);
    const V slope = hn::MulSub(hn::Mul(all(4.0), trace), hn::Sub(square, p.first),
                               hn::Mul(all(8.0), p.jacobian));
    const V inverse = hn::Div(all(1.0), slope);
    const V a = hn::NegMulAdd(hn::Mul(all(8.0), hn::Add(square, p.first)), inverse, all(2.0));
    const V b = hn::Mul(all(16.0), inverse);
    const V c = hn::NegMulAdd(hn::Mul(all(16.0), trace), inverse, byJacobian);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const V turned = hn::MulAdd(
                p.f[i][0], p.metric[0][k],
                hn::MulAdd(p.f[i][1], p.metric[1][k], hn::Mul(p.f[i][2], p.metric[2][k])));
            V& sum = stress[i][k].at[slopeOf(k, g)];
            sum = hn::Add(
                sum, hn::MulAdd(a, p.f[i][k], hn::MulAdd(b, turned, hn::Mul(c, p.cofactor[i][k]))));
        }
}

/// Processes one cell a lane.
HWY_INLINE bool someEnergies(const CellShape& shape, const Flesh& flesh, std::size_t lane,
                             CellBatch& batch) {
    const Tag d;
    Slopes slopes[3][3], stress[3][3], dilation[3][3];
    const V perEdge = all(1.0 / shape.edge);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t e = 0; e < 4; ++e) {
                slopes[i][k].at[e] = hn::Mul(
                    perEdge, hn::Sub(hn::Load(d, batch.corner[i][cornerAt(k, 1, e)] + lane),
                                     hn::Load(d, batch.corner[i][cornerAt(k, 0, e)] + lane)));
                stress[i][k].at[e] = dilation[i][k].at[e] = hn::Zero(d);
            }
            toGauss(slopes[i][k]);
        }

    V energy = hn::Zero(d), sum = hn::Zero(d);
    for (std::size_t g = 0; g < CellShape::kPoints; ++g) {
        const GaussPoint p = pointAt(slopes, g);
        if (!hn::AllTrue(d, hn::Gt(p.jacobian, hn::Zero(d)))) return false;
        sum = hn::Add(sum, p.jacobian);
        const V trace = traceOf(p);
        V byJacobian;
        energy = hn::Add(energy, energyAt(flesh, p, trace, byJacobian));
        addStress(p, trace, byJacobian, g, stress);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                V& entry = dilation[i][k].at[slopeOf(k, g)];
                entry = hn::Add(entry, p.cofactor[i][k]);
            }
    }

    constexpr double kShare = 1.0 / CellShape::kPoints;
    const V volume = all(shape.volumeOfPoint());
    const V change = hn::MulSub(all(kShare), sum, all(1.0)),
            bulk = hn::Mul(all(flesh.bulk), change);
    energy = hn::MulAdd(hn::Mul(all(0.5 * CellShape::kPoints), bulk), change, energy);
    hn::Store(hn::Mul(volume, energy), d, batch.energy + lane);
    const V scale = hn::Mul(volume, perEdge);
    for (std::size_t i = 0; i < 3; ++i) {
        V gradient[CellShape::kCorners];
        for (V& entry : gradient) entry = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
            Slopes& by = stress[i][k];
            for (std::size_t e = 0; e < 4; ++e)
                by.at[e] = hn::MulAdd(bulk, dilation[i][k].at[e], by.at[e]);
            toGauss(by);
            for (std::size_t e = 0; e < 4; ++e) {
                V& high = gradient[cornerAt(k, 1, e)];
                V& low = gradient[cornerAt(k, 0, e)];
                high = hn::Add(high, by.at[e]);
                low = hn::Sub(low, by.at[e]);
            }
        }
        for (std::size_t c = 0; c < CellShape::kCorners; ++c)
            hn::Store(hn::Mul(scale, gradient[c]), d, batch.gradient[i][c] + lane);
    }
    return true;
}

bool allEnergies(const CellShape& shape, const Flesh& flesh, CellBatch& batch) {
    for (std::size_t lane = 0; lane < CellBatch::kCells; lane += hn::Lanes(Tag()))
        if (!someEnergies(shape, flesh, lane, batch)) return false;
    return true;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin::elastic
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin::elastic {

HWY_EXPORT(allEnergies);

bool cellEnergies(const CellShape& shape, const Flesh& flesh, CellBatch& batch) {
    return HWY_DYNAMIC_DISPATCH(allEnergies)(shape, flesh, batch);
}

} // namespace osgSkin::elastic
#endif
