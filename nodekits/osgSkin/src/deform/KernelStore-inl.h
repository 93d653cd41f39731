// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELSTORE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELSTORE_INL_H
#undef OSGSKIN_KERNELSTORE_INL_H
#else
#define OSGSKIN_KERNELSTORE_INL_H
#endif

#include <hwy/highway.h>

#include "deform/DeformKernel.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kBlock>;
using V = hn::Vec<D>;

/// Stores x0 y0 z0 x1 y1 z1 ... Highway's StoreInterleaved3() takes twice as many shuffles on x86.
HWY_INLINE void storeTriples(V x, V y, V z, float* HWY_RESTRICT to) {
#if HWY_TARGET == HWY_SCALAR
    to[0] = hn::GetLane(x);
    to[1] = hn::GetLane(y);
    to[2] = hn::GetLane(z);
#elif HWY_TARGET <= HWY_AVX3
    // First the lanes of x and y, then z's between them (index 16 and up: the second operand).
    const __m512i xy0 = _mm512_setr_epi32(0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5);
    const __m512i xy1 = _mm512_setr_epi32(21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26);
    const __m512i xy2 = _mm512_setr_epi32(0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
    const __m512i z0 = _mm512_setr_epi32(0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
    const __m512i z1 = _mm512_setr_epi32(0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
    const __m512i z2 = _mm512_setr_epi32(26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
    const auto merge = [&](__m512i xy, __m512i last) HWY_ATTR {
        return _mm512_permutex2var_ps(_mm512_permutex2var_ps(x.raw, xy, y.raw), last, z.raw);
    };
    _mm512_storeu_ps(to, merge(xy0, z0));
    _mm512_storeu_ps(to + 16, merge(xy1, z1));
    _mm512_storeu_ps(to + 32, merge(xy2, z2));
#elif HWY_TARGET == HWY_AVX2
    const __m256 xy = _mm256_shuffle_ps(x.raw, y.raw, _MM_SHUFFLE(2, 0, 2, 0));
    const __m256 yz = _mm256_shuffle_ps(y.raw, z.raw, _MM_SHUFFLE(3, 1, 3, 1));
    const __m256 zx = _mm256_shuffle_ps(z.raw, x.raw, _MM_SHUFFLE(3, 1, 2, 0));
    const __m256 p = _mm256_shuffle_ps(xy, zx, _MM_SHUFFLE(2, 0, 2, 0));
    const __m256 q = _mm256_shuffle_ps(yz, xy, _MM_SHUFFLE(3, 1, 2, 0));
    const __m256 r = _mm256_shuffle_ps(zx, yz, _MM_SHUFFLE(3, 1, 3, 1));
    _mm_storeu_ps(to, _mm256_castps256_ps128(p));
    _mm_storeu_ps(to + 4, _mm256_castps256_ps128(q));
    _mm_storeu_ps(to + 8, _mm256_castps256_ps128(r));
    _mm_storeu_ps(to + 12, _mm256_extractf128_ps(p, 1));
    _mm_storeu_ps(to + 16, _mm256_extractf128_ps(q, 1));
    _mm_storeu_ps(to + 20, _mm256_extractf128_ps(r, 1));
#elif HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
    const __m128 xy = _mm_shuffle_ps(x.raw, y.raw, _MM_SHUFFLE(2, 0, 2, 0)); // x0 x2 y0 y2
    const __m128 yz = _mm_shuffle_ps(y.raw, z.raw, _MM_SHUFFLE(3, 1, 3, 1)); // y1 y3 z1 z3
    const __m128 zx = _mm_shuffle_ps(z.raw, x.raw, _MM_SHUFFLE(3, 1, 2, 0)); // z0 z2 x1 x3
    _mm_storeu_ps(to, _mm_shuffle_ps(xy, zx, _MM_SHUFFLE(2, 0, 2, 0)));      // x0 y0 z0 x1
    _mm_storeu_ps(to + 4, _mm_shuffle_ps(yz, xy, _MM_SHUFFLE(3, 1, 2, 0)));  // y1 z1 x2 y2
    _mm_storeu_ps(to + 8, _mm_shuffle_ps(zx, yz, _MM_SHUFFLE(3, 1, 3, 1)));  // z2 x3 y3 z3
#else
    hn::StoreInterleaved3(x, y, z, D(), to);
#endif
}

/// An output array of a group.
struct Output {
    float* to;            ///< of the group's first vertex; with scatter, of vertex 0
    std::size_t straight; ///< vectors that start before this vertex are stored whole
    std::size_t vertexCount;
    const std::uint32_t* scatter;

    HWY_INLINE Output(const KernelCall& call, float* stream)
        : to(stream), straight(0), vertexCount(call.vertexCount), scatter(call.scatter) {
        const std::size_t lanes = hn::Lanes(D());
        if (!scatter && call.room >= lanes) straight = call.room - lanes + 1;
    }
};

/// Stores a vector past the end, or not in order, vertex by vertex. From memory: GCC 12 omits
/// vzeroupper after calls with vectors as arguments.
template <std::size_t kParts>
HWY_NOINLINE void storeSingly(float* to, const std::uint32_t* scatter, std::size_t first,
                              std::size_t end, const float* from) {
    for (std::size_t i = first; i < end; ++i, from += kParts)
        std::memcpy(to + kParts * (scatter ? scatter[i] : i), from, kParts * sizeof(float));
}

template <std::size_t kParts>
HWY_INLINE void storeSingly(const Output& out, std::size_t first, const float* from) {
    storeSingly<kParts>(out.to, out.scatter, first,
                        HWY_MIN(first + hn::Lanes(D()), out.vertexCount), from);
}

/// Stores a vector of vertices from the group's `first` on.
HWY_INLINE void store(const Output& out, std::size_t first, V x, V y, V z) {
    if (HWY_LIKELY(first < out.straight)) {
        storeTriples(x, y, z, out.to + 3 * first);
        return;
    }
    float buffer[3 * kBlock];
    storeTriples(x, y, z, buffer);
    storeSingly<3>(out, first, buffer);
}

/// The same with a fourth part.
HWY_INLINE void store(const Output& out, std::size_t first, V x, V y, V z, V w) {
    if (HWY_LIKELY(first < out.straight)) {
        hn::StoreInterleaved4(x, y, z, w, D(), out.to + 4 * first);
        return;
    }
    float buffer[4 * kBlock];
    hn::StoreInterleaved4(x, y, z, w, D(), buffer);
    storeSingly<4>(out, first, buffer);
}

/// The x row of a vector of tangents, from `first` on; y, z and w follow.
HWY_INLINE const float* tangentLanes(const KernelCall& call, std::size_t first) {
    return call.tangentRows[first / kBlock * SkinBlocks::kTangentRows].lane + first % kBlock;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
