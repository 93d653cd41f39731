// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set by foreach_target.h, which includes this file again and
// again; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DeformKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "DeformKernel.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kBlock>;
using V = hn::Vec<D>;

HWY_INLINE V constant(const Splat& splat) {
    const D d;
#if HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4
    return hn::Load(d, splat.value); // a memory operand: these targets have few registers
#else
    return hn::Set(d, splat.value[0]);
#endif
}

/// Sine and cosine of 2h for |h| <= pi / 2: minimax polynomials (errors 4e-9 and 5e-8) for h, then
/// the double angle. No range reduction is needed, which is why h is the half angle.
HWY_INLINE void sineCosineOfDouble(V h, V& sine, V& cosine) {
    const D d;
    const V t = hn::Mul(h, h);
    V s = hn::MulAdd(t, hn::Set(d, 2.590327920e-06f), hn::Set(d, -1.980081852e-04f));
    V c = hn::MulAdd(t, hn::Set(d, 2.315233523e-05f), hn::Set(d, -1.385363539e-03f));
    s = hn::MulAdd(t, s, hn::Set(d, 8.332898540e-03f));
    c = hn::MulAdd(t, c, hn::Set(d, 4.166357559e-02f));
    s = hn::MulAdd(t, s, hn::Set(d, -1.666664756e-01f));
    c = hn::MulAdd(t, c, hn::Set(d, -4.999990497e-01f));
    s = hn::MulAdd(t, s, hn::Set(d, 9.999999765e-01f));
    c = hn::MulAdd(t, c, hn::Set(d, 9.999999532e-01f));
    s = hn::Mul(h, s);
    const V twice = hn::Add(s, s);
    sine = hn::Mul(twice, c);
    cosine = hn::NegMulAdd(twice, s, hn::Set(d, 1.0f));
}

/// Turns (a, b) in its plane.
HWY_INLINE void turnPlane(V sine, V cosine, V& a, V& b) {
    const V old = a;
    a = hn::MulSub(cosine, a, hn::Mul(sine, b));
    b = hn::MulAdd(sine, old, hn::Mul(cosine, b));
}

HWY_INLINE V mapRow(const Splat (&row)[3], V x, V y, V z) {
    return hn::MulAdd(constant(row[2]), z,
                      hn::MulAdd(constant(row[1]), y, hn::Mul(constant(row[0]), x)));
}

HWY_INLINE void turn(const KernelMap& map, V& x, V& y, V& z) {
    const V a = mapRow(map.turn[0], x, y, z);
    const V b = mapRow(map.turn[1], x, y, z);
    z = mapRow(map.turn[2], x, y, z);
    x = a;
    y = b;
}

HWY_INLINE V movedRow(const Splat (&row)[3], const Splat& move, V x, V y, V z) {
    return hn::MulAdd(
        constant(row[2]), z,
        hn::MulAdd(constant(row[1]), y, hn::MulAdd(constant(row[0]), x, constant(move))));
}

HWY_INLINE void apply(const KernelMap& map, V& x, V& y, V& z) {
    const V a = movedRow(map.turn[0], map.move[0], x, y, z);
    const V b = movedRow(map.turn[1], map.move[1], x, y, z);
    z = movedRow(map.turn[2], map.move[2], x, y, z);
    x = a;
    y = b;
}

/// Stores x0 y0 z0 x1 y1 z1 ... Highway's own way takes twice as many shuffles on x86.
HWY_INLINE void storeTriples(V x, V y, V z, float* HWY_RESTRICT to) {
#if HWY_TARGET == HWY_SCALAR
    to[0] = hn::GetLane(x);
    to[1] = hn::GetLane(y);
    to[2] = hn::GetLane(z);
#elif HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
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
    // Lane 3j % 8 for x_j, whichever of the three vectors it goes to; then blends only.
    const __m256 px = _mm256_permutevar8x32_ps(x.raw, _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5));
    const __m256 py = _mm256_permutevar8x32_ps(y.raw, _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2));
    const __m256 pz = _mm256_permutevar8x32_ps(z.raw, _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7));
    _mm256_storeu_ps(to, _mm256_blend_ps(_mm256_blend_ps(px, py, 0x92), pz, 0x24));
    _mm256_storeu_ps(to + 8, _mm256_blend_ps(_mm256_blend_ps(px, py, 0x24), pz, 0x49));
    _mm256_storeu_ps(to + 16, _mm256_blend_ps(_mm256_blend_ps(px, py, 0x49), pz, 0x92));
#elif HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
    const __m128 xy = _mm_unpacklo_ps(x.raw, y.raw);                          // x0 y0 x1 y1
    const __m128 zx = _mm_shuffle_ps(z.raw, x.raw, _MM_SHUFFLE(1, 1, 0, 0));  // z0 z0 x1 x1
    const __m128 yz = _mm_shuffle_ps(y.raw, z.raw, _MM_SHUFFLE(1, 1, 1, 1));  // y1 y1 z1 z1
    const __m128 xy2 = _mm_unpackhi_ps(x.raw, y.raw);                         // x2 y2 x3 y3
    const __m128 zx2 = _mm_shuffle_ps(z.raw, x.raw, _MM_SHUFFLE(3, 3, 2, 2)); // z2 z2 x3 x3
    const __m128 yz3 = _mm_shuffle_ps(y.raw, z.raw, _MM_SHUFFLE(3, 3, 3, 3)); // y3 y3 z3 z3
    _mm_storeu_ps(to, _mm_shuffle_ps(xy, zx, _MM_SHUFFLE(2, 0, 1, 0)));
    _mm_storeu_ps(to + 4, _mm_shuffle_ps(yz, xy2, _MM_SHUFFLE(1, 0, 2, 0)));
    _mm_storeu_ps(to + 8, _mm_shuffle_ps(zx2, yz3, _MM_SHUFFLE(2, 0, 2, 0)));
#else
    hn::StoreInterleaved3(x, y, z, D(), to);
#endif
}

/// Stores a vector's vertices; those that would run past the end, or are not in order, by way of
/// the stack.
HWY_INLINE void store(const KernelCall& call, std::size_t first, float* HWY_RESTRICT to, V x, V y,
                      V z) {
    const std::size_t lanes = hn::Lanes(D());
    if (HWY_LIKELY(!call.scatter && first + lanes <= call.room)) {
        storeTriples(x, y, z, to + 3 * first);
        return;
    }
    float buffer[3 * kBlock];
    storeTriples(x, y, z, buffer);
    const std::size_t count = HWY_MIN(lanes, call.vertexCount - first);
    if (!call.scatter) {
        std::memcpy(to + 3 * first, buffer, 3 * count * sizeof(float));
        return;
    }
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(to + 3 * std::size_t(call.scatter[first + i]), buffer + 3 * i,
                    3 * sizeof(float));
}

/// The same for a vector's tangents, w kept.
HWY_INLINE void storeTangents(const KernelCall& call, std::size_t first, V x, V y, V z, V w) {
    const std::size_t lanes = hn::Lanes(D());
    if (HWY_LIKELY(!call.scatter && first + lanes <= call.room)) {
        hn::StoreInterleaved4(x, y, z, w, D(), call.tangents + 4 * first);
        return;
    }
    float buffer[4 * kBlock];
    hn::StoreInterleaved4(x, y, z, w, D(), buffer);
    const std::size_t count = HWY_MIN(lanes, call.vertexCount - first);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(call.tangents + 4 * (call.scatter ? call.scatter[first + i] : first + i),
                    buffer + 4 * i, 4 * sizeof(float));
}

/// A direction of each vertex of a vector: a normal or a tangent.
struct Direction {
    V x, y, z;

    HWY_INLINE void load(const float* HWY_RESTRICT rows) {
        const D d;
        x = hn::Load(d, rows);
        y = hn::Load(d, rows + kBlock);
        z = hn::Load(d, rows + 2 * kBlock);
    }
};

template <bool kNormals, bool kTangents, bool kMoved>
HWY_INLINE void deformLanes(const KernelCall& call, std::size_t first,
                            const float* HWY_RESTRICT rows, const float* HWY_RESTRICT tangentRows) {
    const D d;
    V x = hn::Load(d, rows), y = hn::Load(d, rows + kBlock), z = hn::Load(d, rows + 2 * kBlock);
    Direction n, t;
    if (kNormals) n.load(rows + 3 * kBlock);
    if (kTangents) t.load(tangentRows);
    if (call.lead) {
        apply(*call.lead, x, y, z);
        if (kNormals) turn(*call.lead, n.x, n.y, n.z);
        if (kTangents) turn(*call.lead, t.x, t.y, t.z);
    }
    const float* HWY_RESTRICT ratio = rows + 6 * kBlock;
    bool inJointFrame = !call.lead;
    for (const KernelLink* link = call.links + call.linkCount; link-- != call.links;
         ratio += 2 * kBlock, inJointFrame = false) {
        const V bendRatio = hn::Load(d, ratio);
        V sine, cosine;
        sineCosineOfDouble(hn::Mul(hn::Load(d, ratio + kBlock), constant(link->halfTwist)), sine,
                           cosine);
        if (inJointFrame) {
            // R_w(b - z): the rest data's fixed frame differs from (v, w x v, w) by v's azimuth z.
            const V old = cosine;
            cosine = hn::MulAdd(old, constant(call.azimuthCosine),
                                hn::Mul(sine, constant(call.azimuthSine)));
            sine = hn::MulSub(sine, constant(call.azimuthCosine),
                              hn::Mul(old, constant(call.azimuthSine)));
        }
        turnPlane(sine, cosine, x, y);
        if (kNormals) turnPlane(sine, cosine, n.x, n.y);
        if (kTangents) turnPlane(sine, cosine, t.x, t.y);
        sineCosineOfDouble(hn::Mul(bendRatio, constant(link->halfBend)), sine, cosine);
        turnPlane(sine, cosine, y, z);
        if (kNormals) turnPlane(sine, cosine, n.y, n.z);
        if (kTangents) turnPlane(sine, cosine, t.y, t.z);
        if (kMoved) {
            x = hn::MulAdd(bendRatio, constant(link->move[0]), x);
            y = hn::MulAdd(bendRatio, constant(link->move[1]), y);
            z = hn::MulAdd(bendRatio, constant(link->move[2]), z);
        }
        apply(link->out, x, y, z);
        if (kNormals) turn(link->out, n.x, n.y, n.z);
        if (kTangents) turn(link->out, t.x, t.y, t.z);
    }
    store(call, first, call.positions, x, y, z);
    if (kNormals) store(call, first, call.normals, n.x, n.y, n.z);
    if (kTangents) storeTangents(call, first, t.x, t.y, t.z, hn::Load(d, tangentRows + 3 * kBlock));
}

template <bool kNormals, bool kTangents, bool kMoved>
void deformGroup(const KernelCall& call) {
    const std::size_t lanes = hn::Lanes(D());
    const std::size_t blockRows = SkinBlocks::rowsPerBlock(call.linkCount);
    for (std::size_t first = 0; first < call.vertexCount; first += lanes) {
        const std::size_t block = first / kBlock, lane = first % kBlock;
        deformLanes<kNormals, kTangents, kMoved>(
            call, first, call.rows[block * blockRows].lane + lane,
            kTangents ? call.tangentRows[block * SkinBlocks::kTangentRows].lane + lane : nullptr);
    }
}

template <bool kNormals, bool kTangents>
void deformStreams(const KernelCall& call) {
    call.moved ? deformGroup<kNormals, kTangents, true>(call)
               : deformGroup<kNormals, kTangents, false>(call);
}

void deform(const KernelCall& call) {
    if (call.tangents)
        deformStreams<true, true>(call);
    else if (call.normals)
        deformStreams<true, false>(call);
    else
        deformStreams<false, false>(call);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(deform);

void runKernel(const KernelCall& call) noexcept {
    HWY_DYNAMIC_DISPATCH(deform)(call);
}

} // namespace osgSkin
#endif
