// SPDX-License-Identifier: MIT
//
// Included by PoseKernel.cpp once for each instruction set.
#if defined(OSGSKIN_JOINTLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_JOINTLANES_INL_H
#undef OSGSKIN_JOINTLANES_INL_H
#else
#define OSGSKIN_JOINTLANES_INL_H
#endif

#include <hwy/highway.h>

#include "points/Doubles-inl.h"
#include "pose/PoseKernel.h"

#include <cmath>
#include <cstddef>

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

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
