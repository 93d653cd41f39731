// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, through foreach_target.h; the best is chosen at run time.
#include "deform/DeformKernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/DeformKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "deform/KernelCorrect-inl.h"
#include "deform/KernelRotations-inl.h"
#include "deform/KernelStore-inl.h"
#include "deform/KernelSurface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// The prefetch distance of the outputs, in floats: a crowd's outputs are in no cache.
constexpr std::size_t kAhead = 512;

/// The prefetch distance of the skin's rows, for skins larger than the caches.
constexpr std::size_t kRowsAhead = 32;
constexpr std::size_t kSlopesAhead = 32;

/// Prefetches a vector's part of `kRows` rows of a block, some rows ahead.
///
/// \param at the first row, at the vector's lanes
/// \param lane the vector's first lane in the block
template <std::size_t kRows, typename T>
HWY_INLINE void prefetchRows(const T* at, std::size_t rowsAhead, std::size_t lane) {
    constexpr std::size_t kLine = 64 / sizeof(T);
    const T* const from = at + rowsAhead * kBlock + lane * (kRows - 1);
    for (std::size_t i = 0; i < kRows * hn::MaxLanes(D()); i += kLine) hwy::Prefetch(from + i);
}

struct Outputs {
    Output positions, normals, tangents;
};

template <bool kNormals>
HWY_INLINE void prefetch(const Outputs& out, std::size_t first) {
    for (std::size_t i = 0; i < 3 * hn::Lanes(D()); i += 16) {
        hwy::Prefetch(out.positions.to + 3 * first + kAhead + i);
        if (kNormals) hwy::Prefetch(out.normals.to + 3 * first + kAhead + i);
    }
}

template <bool kNormals, bool kTangents>
HWY_INLINE void deformVector(const KernelCall& call, const Outputs& out, std::size_t first,
                             const float* HWY_RESTRICT rows,
                             const float* HWY_RESTRICT tangentRows) {
    const D d;
    const std::size_t lane = first % kBlock;
    prefetchRows<kNormals ? 6 : 3>(rows, kRowsAhead, lane);
    V x = hn::Load(d, rows), y = hn::Load(d, rows + kBlock), z = hn::Load(d, rows + 2 * kBlock);
    if (HWY_UNLIKELY(call.correctionCount > 0)) correct(call, first, x, y, z);
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
    if (kNormals && HWY_UNLIKELY(call.correctionCount > 0 || call.morphTilts))
        correctNormals<kTangents>(call, first, nx, ny, nz, tx, ty, tz);
    if (call.lead) {
        if (HWY_UNLIKELY(call.lead->scale() != 1.0f))
            scaleBy(constant(call.lead->scale()), x, y, z);
        apply(*call.lead, x, y, z);
        if (kNormals) turn(*call.lead, nx, ny, nz);
        if (kTangents) turn(*call.lead, tx, ty, tz);
    }
    const float* HWY_RESTRICT ratio = rows + 6 * kBlock;
    bool inJointFrame = !call.lead;
    for (std::size_t l = call.linkCount; l-- != 0; ratio += 2 * kBlock, inJointFrame = false) {
        const KernelLink* const link = call.links + l;
        prefetchRows<2>(ratio, kRowsAhead, lane);
        const V bendRatio = hn::Load(d, ratio);
        V sine, cosine;
        sineCosine(call.joints->twistOf(link->joint), hn::Load(d, ratio + kBlock), sine, cosine);
        if (inJointFrame) subtractAzimuth(call, *link, sine, cosine);
        rotate2D(sine, cosine, x, y);
        if (kNormals) rotate2D(sine, cosine, nx, ny);
        if (kTangents) rotate2D(sine, cosine, tx, ty);
        sineCosine(call.joints->bendOf(link->joint), bendRatio, sine, cosine);
        rotate2D(sine, cosine, y, z);
        if (kNormals) rotate2D(sine, cosine, ny, nz);
        if (kTangents) rotate2D(sine, cosine, ty, tz);
        if (HWY_UNLIKELY(call.isAdjusted(*link))) adjust(call, *link, bendRatio, x, y, z);
        apply(call.outs[link->out], x, y, z);
        if (kNormals) turn(call.outs[link->out], nx, ny, nz);
        if (kTangents) turn(call.outs[link->out], tx, ty, tz);
    }
    prefetch<kNormals>(out, first);
    store(out.positions, first, x, y, z);
    if (kNormals) store(out.normals, first, nx, ny, nz);
    if (kTangents) store(out.tangents, first, tx, ty, tz, hn::Load(d, tangentRows + 3 * kBlock));
}

/// The same with normals and tangents of the deformed surface: two directions along the skin go
/// through the chain up to the last link that tilts it, normal and tangent from there on.
template <bool kTangents>
HWY_INLINE void deformSurface(const KernelCall& call, const Outputs& out, std::size_t first,
                              const float* HWY_RESTRICT rows,
                              const float* HWY_RESTRICT tangentRows) {
    const D d;
    const std::size_t lane = first % kBlock;
    prefetchRows<6>(rows, kRowsAhead, lane);
    V x = hn::Load(d, rows), y = hn::Load(d, rows + kBlock), z = hn::Load(d, rows + 2 * kBlock);
    if (HWY_UNLIKELY(call.correctionCount > 0)) correct(call, first, x, y, z);
    const std::int16_t* HWY_RESTRICT slopes = gradientLanes(call, first);
    V ux, uy, uz, vx, vy, vz;
    skinDirections(call, first, hn::Load(d, rows + 3 * kBlock), hn::Load(d, rows + 4 * kBlock),
                   hn::Load(d, rows + 5 * kBlock), ux, uy, uz, vx, vy, vz);
    V tx = hn::Zero(d), ty = tx, tz = tx, alongU = tx, alongV = tx, square = tx;
    if (kTangents) {
        tx = hn::Load(d, tangentRows);
        ty = hn::Load(d, tangentRows + kBlock);
        tz = hn::Load(d, tangentRows + 2 * kBlock);
        alongU = dot(tx, ty, tz, ux, uy, uz);
        alongV = dot(tx, ty, tz, vx, vy, vz);
        square = dot(tx, ty, tz, tx, ty, tz);
    }
    if (call.lead) {
        if (HWY_UNLIKELY(call.lead->scale() != 1.0f)) {
            scaleBy(constant(call.lead->scale()), x, y, z);
            scaleBy(constant(call.lead->scale()), ux, uy, uz);
            scaleBy(constant(call.lead->scale()), vx, vy, vz);
        }
        apply(*call.lead, x, y, z);
        turn(*call.lead, ux, uy, uz);
        turn(*call.lead, vx, vy, vz);
    }
    const float* HWY_RESTRICT ratio = rows + 6 * kBlock;
    bool inJointFrame = !call.lead;
    const KernelLink* link = call.links + call.linkCount;
    const KernelLink* const last = call.links + call.lastSlope;
    V nx = tx, ny = tx, nz = tx;
    for (;;) {
        --link;
        prefetchRows<2>(ratio, kRowsAhead, lane);
        prefetchRows<kSlopeRows>(slopes, kSlopesAhead, lane);
        const V bendRatio = hn::Load(d, ratio);
        V sine, cosine;
        sineCosine(call.joints->twistOf(link->joint), hn::Load(d, ratio + kBlock), sine, cosine);
        if (inJointFrame) subtractAzimuth(call, *link, sine, cosine);
        if (call.isTiltedByTwist(*link)) {
            const float& twistSlope = call.twistSlopes[link->joint];
            addSlope(slopeAt(slopes, kTwistAlongU, twistSlope), x, y, ux, uy);
            addSlope(slopeAt(slopes, kTwistAlongV, twistSlope), x, y, vx, vy);
        }
        rotate2D(sine, cosine, x, y);
        rotate2D(sine, cosine, ux, uy);
        rotate2D(sine, cosine, vx, vy);
        sineCosine(call.joints->bendOf(link->joint), bendRatio, sine, cosine);
        if (call.isTiltedByBend(*link)) {
            const float& bendSlope = call.bendSlopes[link->joint];
            addSlope(slopeAt(slopes, kBendAlongU, bendSlope), y, z, uy, uz);
            addSlope(slopeAt(slopes, kBendAlongV, bendSlope), y, z, vy, vz);
        }
        rotate2D(sine, cosine, y, z);
        if (link == last && HWY_LIKELY(!call.isAdjusted(*link))) {
            if (HWY_UNLIKELY(call.joints->anyAdjusted)) bringIntoRange(ux, uy, uz, vx, vy, vz);
            cross(ux, uy, uz, vx, vy, vz, nx, ny, nz);
            rotate2D(sine, cosine, ny, nz);
            if (kTangents) {
                combine(alongU, alongV, ux, uy, uz, vx, vy, vz, tx, ty, tz);
                rotate2D(sine, cosine, ty, tz);
            }
            apply(call.outs[link->out], x, y, z);
            break;
        }
        rotate2D(sine, cosine, uy, uz);
        rotate2D(sine, cosine, vy, vz);
        if (HWY_UNLIKELY(call.isAdjusted(*link))) {
            adjustAlong(call, *link, bendRatio, slopeAt(slopes, kBendAlongU, call.slopeUnit), x, y,
                        z, ux, uy, uz);
            adjustAlong(call, *link, bendRatio, slopeAt(slopes, kBendAlongV, call.slopeUnit), x, y,
                        z, vx, vy, vz);
            adjust(call, *link, bendRatio, x, y, z);
        }
        apply(call.outs[link->out], x, y, z);
        if (link == last) {
            bringIntoRange(ux, uy, uz, vx, vy, vz);
            cross(ux, uy, uz, vx, vy, vz, nx, ny, nz);
            if (kTangents) combine(alongU, alongV, ux, uy, uz, vx, vy, vz, tx, ty, tz);
            break;
        }
        turn(call.outs[link->out], ux, uy, uz);
        turn(call.outs[link->out], vx, vy, vz);
        ratio += 2 * kBlock;
        slopes += kSlopeRows * kBlock;
        inJointFrame = false;
    }
    // Starts the roots early: they are needed only at the end.
    const V length = inverseRoot(dot(nx, ny, nz, nx, ny, nz));
    turn(call.outs[last->out], nx, ny, nz);
    if (kTangents) {
        scaleBy(hn::Mul(hn::Sqrt(square), inverseRoot(dot(tx, ty, tz, tx, ty, tz))), tx, ty, tz);
        turn(call.outs[last->out], tx, ty, tz);
    }
    ratio += 2 * kBlock;
    while (link != call.links) {
        --link;
        prefetchRows<2>(ratio, kRowsAhead, lane);
        const V bendRatio = hn::Load(d, ratio);
        V sine, cosine;
        sineCosine(call.joints->twistOf(link->joint), hn::Load(d, ratio + kBlock), sine, cosine);
        rotate2D(sine, cosine, x, y);
        rotate2D(sine, cosine, nx, ny);
        if (kTangents) rotate2D(sine, cosine, tx, ty);
        sineCosine(call.joints->bendOf(link->joint), bendRatio, sine, cosine);
        rotate2D(sine, cosine, y, z);
        rotate2D(sine, cosine, ny, nz);
        if (kTangents) rotate2D(sine, cosine, ty, tz);
        if (HWY_UNLIKELY(call.isAdjusted(*link))) adjust(call, *link, bendRatio, x, y, z);
        apply(call.outs[link->out], x, y, z);
        turn(call.outs[link->out], nx, ny, nz);
        if (kTangents) turn(call.outs[link->out], tx, ty, tz);
        ratio += 2 * kBlock;
    }
    prefetch<true>(out, first);
    store(out.positions, first, x, y, z);
    scaleBy(length, nx, ny, nz);
    store(out.normals, first, nx, ny, nz);
    if (kTangents) store(out.tangents, first, tx, ty, tz, hn::Load(d, tangentRows + 3 * kBlock));
}

/// Deforms a vector of a block.
template <bool kNormals, bool kTangents, bool kSurface>
HWY_INLINE void deformAt(const KernelCall& call, const Outputs& out, std::size_t first,
                         const BlockRow* rows) {
    const float* const lanes = rows->lane + first % kBlock;
    const float* const tangentRows = kTangents ? tangentLanes(call, first) : nullptr;
    if (kSurface)
        deformSurface<kTangents>(call, out, first, lanes, tangentRows);
    else
        deformVector<kNormals, kTangents>(call, out, first, lanes, tangentRows);
}

/// Deforms a group vector by vector, each through its whole chain.
template <bool kNormals, bool kTangents, bool kSurface>
HWY_INLINE void deformByVectors(const KernelCall& call) {
    const Outputs out{Output(call, call.positions), Output(call, call.normals),
                      Output(call, call.tangents)};
    const std::size_t blockRows = SkinBlocks::rowsPerBlock(call.linkCount);
    const BlockRow* rows = call.rows;
    for (std::size_t first = 0; first < call.vertexCount; first += kBlock, rows += blockRows) {
        if (hn::MaxLanes(D()) == kBlock) { // no inner loop
            deformAt<kNormals, kTangents, kSurface>(call, out, first, rows);
            continue;
        }
        const std::size_t end = HWY_MIN(first + kBlock, call.vertexCount);
        for (std::size_t v = first; v < end; v += hn::Lanes(D()))
            deformAt<kNormals, kTangents, kSurface>(call, out, v, rows);
    }
}

/// Sets the constants of a run's groups.
HWY_INLINE void startRun(const KernelRun& run, KernelCall& call) {
    call.joints = run.joints;
    call.outs = run.outs;
    call.weights = run.weights;
    call.correctionCount = 0;
    call.corrections = nullptr;
    call.shareFrame = call.normalShareFrame = nullptr;
    call.firstBlock = run.skippedBlocks;
    call.gradients = nullptr;
    call.bendSlopes = run.bendSlopes;
    call.twistSlopes = run.twistSlopes;
    call.slopeUnit = run.slopeUnit;
}

/// Sets the correctives of a group.
HWY_INLINE void startCorrections(const KernelRun& run, std::size_t number,
                                 const SkinBlocks::Group& group, KernelCall& call) {
    const CorrectiveBlocks& of = *run.corrections;
    const std::uint32_t* const range = of.firstRange.data() + number;
    call.corrections = of.corrected.data() + range[0];
    const std::size_t count = range[1] - range[0];
    call.correctionCount = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (run.weights[call.corrections[i].joint]) call.correctionCount = count;
    call.shareFrame = of.shareFrames[number];
    call.normalShareFrame =
        group.frame == SkinBlocks::kRestFrame ? nullptr : of.frames.data() + group.frame;
}

/// Sets the constants of a group, without its gradients.
HWY_INLINE void startGroup(const KernelRun& run, std::size_t i, KernelCall& call) {
    const SkinBlocks::Group& group = run.groups[i];
    call.linkCount = group.linkCount;
    call.links = run.blocks->plan.links.data() + group.firstLink;
    call.lead = group.lead == ChainPlan::kNoLead ? nullptr : run.outs + group.lead;
    call.rows = run.rows + group.firstRow;
    call.vertexCount = group.vertexCount;
    call.room = run.endVertex - group.firstVertex;
    call.scatter = run.scatter ? run.scatter + group.firstVertex : nullptr;
    const std::size_t vertex = run.scatter ? 0 : group.firstVertex;
    call.positions = run.positions + 3 * vertex;
    call.normals = run.normals ? run.normals + 3 * vertex : nullptr;
    call.tangents = run.tangents ? run.tangents + 4 * vertex : nullptr;
    call.tangentRows =
        run.tangents ? run.tangentRows + group.firstBlock * SkinBlocks::kTangentRows : nullptr;
    if (run.corrections) startCorrections(run, run.firstGroup + i, group, call);
    call.morphTilts = run.morphTilts ? run.morphTilts + std::size_t{3} * group.firstBlock : nullptr;
}

/// Sets a group's gradients, and which of its links tilt normals in this pose.
///
/// \return false where none does: normals then rotate as their vertices do
HWY_INLINE bool startSlopes(const KernelRun& run, std::size_t i, KernelCall& call) {
    const SkinBlocks::Group& group = run.groups[i];
    const std::size_t first = group.firstLink - run.firstTilt;
    call.bendTilts = LinkTilts::some(run.tilts->bends, first, call.linkCount);
    call.twistTilts = LinkTilts::some(run.tilts->twists, first, call.linkCount);
    std::uint32_t tilts = call.bendTilts | call.twistTilts;
    if (HWY_UNLIKELY(run.joints->anyAdjusted))
        for (std::size_t k = 0; k < call.linkCount; ++k)
            tilts |= std::uint32_t(call.isAdjusted(call.links[k])) << k;
    if (tilts == 0) return false;
    call.lastSlope = hwy::Num0BitsBelowLS1Bit_Nonzero32(tilts);
    const GradientBlocks& of = *run.gradients;
    const std::size_t row = of.firstRow[run.firstGroup + i] +
                            run.skippedBlocks * GradientBlocks::rowsPerBlock(call.linkCount);
    call.gradients = of.rows[row].lane;
    call.across = of.across.data() + group.firstBlock;
    return true;
}

template <bool kNormals, bool kTangents, bool kSurface>
void deformGroups(const KernelRun& run) {
    KernelCall call;
    startRun(run, call);
    for (std::size_t i = 0; i < run.groupCount; ++i) {
        startGroup(run, i, call);
        if (kSurface && startSlopes(run, i, call))
            deformByVectors<kNormals, kTangents, true>(call);
        else
            deformByVectors<kNormals, kTangents, false>(call);
    }
}

Kernel kernelFor(bool normals, bool tangents, bool surface) {
    if (tangents) return surface ? deformGroups<true, true, true> : deformGroups<true, true, false>;
    if (normals)
        return surface ? deformGroups<true, false, true> : deformGroups<true, false, false>;
    return deformGroups<false, false, false>;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(kernelFor);

Kernel kernelFor(bool normals, bool tangents, bool surface) noexcept {
    return HWY_DYNAMIC_DISPATCH(kernelFor)(normals, tangents, surface);
}

} // namespace osgSkin
#endif
