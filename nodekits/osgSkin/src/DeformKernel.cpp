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
#include "KernelSine-inl.h"
#include "KernelStore-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

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

template <bool kNormals, bool kTangents>
HWY_INLINE void deformLanes(const KernelCall& call, std::size_t first,
                            const float* HWY_RESTRICT rows, const float* HWY_RESTRICT tangentRows) {
    const D d;
    V x = hn::Load(d, rows), y = hn::Load(d, rows + kBlock), z = hn::Load(d, rows + 2 * kBlock);
    V nx = hn::Zero(d), ny = nx, nz = nx, tx = nx, ty = nx, tz = nx;
    if (kNormals) {
        nx = hn::Load(d, rows + 3 * kBlock);
        ny = hn::Load(d, rows + 4 * kBlock);
        nz = hn::Load(d, rows + 5 * kBlock);
    }
    if (kTangents) {
        tx = hn::Load(d, tangentRows);
        ty = hn::Load(d, tangentRows + kBlock);
        tz = hn::Load(d, tangentRows + 2 * kBlock);
    }
    if (call.lead) {
        apply(*call.lead, x, y, z);
        if (kNormals) turn(*call.lead, nx, ny, nz);
        if (kTangents) turn(*call.lead, tx, ty, tz);
    }
    const float* HWY_RESTRICT ratio = rows + 6 * kBlock;
    bool inJointFrame = !call.lead;
    for (const KernelLink* link = call.links + call.linkCount; link-- != call.links;
         ratio += 2 * kBlock, inJointFrame = false) {
        const V bendRatio = hn::Load(d, ratio);
        V sine, cosine;
        sineCosine(link->twist, hn::Load(d, ratio + kBlock), sine, cosine);
        if (inJointFrame) {
            // R_w(b - z): the rest data's fixed frame differs from (v, w x v, w) by v's azimuth z.
            const V old = cosine;
            cosine = hn::MulAdd(old, constant(call.azimuthCosine),
                                hn::Mul(sine, constant(call.azimuthSine)));
            sine = hn::MulSub(sine, constant(call.azimuthCosine),
                              hn::Mul(old, constant(call.azimuthSine)));
        }
        turnPlane(sine, cosine, x, y);
        if (kNormals) turnPlane(sine, cosine, nx, ny);
        if (kTangents) turnPlane(sine, cosine, tx, ty);
        sineCosine(link->bend, bendRatio, sine, cosine);
        turnPlane(sine, cosine, y, z);
        if (kNormals) turnPlane(sine, cosine, ny, nz);
        if (kTangents) turnPlane(sine, cosine, ty, tz);
        if (HWY_UNLIKELY(link->moved)) {
            x = hn::MulAdd(bendRatio, constant(link->move[0]), x);
            y = hn::MulAdd(bendRatio, constant(link->move[1]), y);
            z = hn::MulAdd(bendRatio, constant(link->move[2]), z);
        }
        apply(link->out, x, y, z);
        if (kNormals) turn(link->out, nx, ny, nz);
        if (kTangents) turn(link->out, tx, ty, tz);
    }
    store(call, first, call.positions, x, y, z);
    if (kNormals) store(call, first, call.normals, nx, ny, nz);
    if (kTangents) storeTangents(call, first, tx, ty, tz, hn::Load(d, tangentRows + 3 * kBlock));
}

template <bool kNormals, bool kTangents>
void deformGroup(const KernelCall& call) {
    const std::size_t lanes = hn::Lanes(D());
    const std::size_t blockRows = SkinBlocks::rowsPerBlock(call.linkCount);
    for (std::size_t first = 0; first < call.vertexCount; first += lanes) {
        const std::size_t block = first / kBlock, lane = first % kBlock;
        deformLanes<kNormals, kTangents>(
            call, first, call.rows[block * blockRows].lane + lane,
            kTangents ? call.tangentRows[block * SkinBlocks::kTangentRows].lane + lane : nullptr);
    }
}

void deform(const KernelCall& call) {
    if (call.tangents)
        deformGroup<true, true>(call);
    else if (call.normals)
        deformGroup<true, false>(call);
    else
        deformGroup<false, false>(call);
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
