// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELPASSES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELPASSES_INL_H
#undef OSGSKIN_KERNELPASSES_INL_H
#else
#define OSGSKIN_KERNELPASSES_INL_H
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "deform/DeformKernel.h"
#include "deform/KernelCorrect-inl.h"
#include "deform/KernelRotations-inl.h"
#include "deform/KernelStore-inl.h"
#include "deform/KernelSurface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

enum class Stream { Positions, Normals, Tangents };

/// Blocks that go through a link together; their intermediate results fit into the first-level
/// cache.
constexpr std::size_t kChunkBlocks = 8;
constexpr std::size_t kChunk = kChunkBlocks * kBlock;

struct alignas(64) Chunk {
    std::size_t first = 0;         ///< vertex of the group
    std::size_t blocks = 0;        ///< at most kChunkBlocks
    std::size_t ratioStride = 0;   ///< floats between two blocks' ratios
    const float* ratios = nullptr; ///< of the current link: bend, then twist
    std::size_t slopeStride = 0;
    const std::int16_t* slopes = nullptr; ///< of the current link, see SlopeRow

    float twistSine[kChunk], twistCosine[kChunk]; ///< of the current link
    float bendSine[kChunk], bendCosine[kChunk];
};

/// Positions, normals or tangents of a chunk: x, y and z of a block, then of the next one.
struct alignas(64) ChunkStream {
    const float* from = nullptr; ///< first in the skin's blocks, then in `state`
    std::size_t stride = 0;
    float state[3 * kChunk]; ///< between two links

    HWY_INLINE void useState() {
        from = state;
        stride = 3 * kBlock;
    }
};

/// A chunk's directions along the skin.
struct alignas(64) ChunkSurface {
    ChunkStream u, v;
    float alongU[kChunk], alongV[kChunk], square[kChunk]; ///< of tangents at rest
};

/// sineCosine() for a chunk, with the polynomials scaled to take the ratios directly. With
/// kShifted, subtracts the azimuth.
template <int kDoublings, bool kShifted, std::size_t kTerms>
HWY_INLINE void turnShares(const float (&sineTerms)[kTerms], const float (&cosineTerms)[kTerms - 1],
                           float angle, const KernelCall& call, const KernelLink& link,
                           const Chunk& chunk, const float* HWY_RESTRICT ratio,
                           float* HWY_RESTRICT sines, float* HWY_RESTRICT cosines) {
    const D d;
    float forSine[kTerms], forCosine[kTerms - 1];
    double power = double(angle);
    for (std::size_t i = 0; i < kTerms; ++i, power *= double(angle)) {
        forSine[i] = static_cast<float>(power * double(sineTerms[i]));
        power *= double(angle);
        if (i + 1 < kTerms) forCosine[i] = static_cast<float>(power * double(cosineTerms[i]));
    }
    const V one = hn::Set(d, 1.0f);
    for (std::size_t b = 0; b < chunk.blocks; ++b, ratio += chunk.ratioStride) {
        hwy::Prefetch(ratio + chunk.blocks * chunk.ratioStride);
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const V r = hn::Load(d, ratio + lane);
            const V t = hn::Mul(r, r);
            V sine = hn::Mul(r, polynomial(t, forSine));
            V cosine = hn::MulAdd(t, polynomial(t, forCosine), one);
            for (int i = 0; i < kDoublings; ++i) twice(sine, cosine);
            if (kShifted) subtractAzimuth(call, link, sine, cosine);
            hn::Store(sine, d, sines + b * kBlock + lane);
            hn::Store(cosine, d, cosines + b * kBlock + lane);
        }
    }
}

template <bool kShifted>
HWY_NOINLINE void turnShares(const KernelAngle& angle, const KernelCall& call,
                             const KernelLink& link, const Chunk& chunk, const float* ratio,
                             float* sines, float* cosines) {
    const float value = angle.value;
    switch (angle.range) {
    case KernelAngle::kSmall:
        return turnShares<0, kShifted>(kSmallSine, kSmallCosine, value, call, link, chunk, ratio,
                                       sines, cosines);
    case KernelAngle::kMedium:
        return turnShares<0, kShifted>(kMediumSine, kMediumCosine, value, call, link, chunk, ratio,
                                       sines, cosines);
    case KernelAngle::kLarge:
        return turnShares<0, kShifted>(kLargeSine, kLargeCosine, value, call, link, chunk, ratio,
                                       sines, cosines);
    case KernelAngle::kHalved:
        return turnShares<1, kShifted>(kLargeSine, kLargeCosine, value, call, link, chunk, ratio,
                                       sines, cosines);
    case KernelAngle::kQuartered:
        return turnShares<2, kShifted>(kLargeSine, kLargeCosine, value, call, link, chunk, ratio,
                                       sines, cosines);
    }
}

/// Takes a stream through a link, or a map alone where there is none; the last goes to the output.
template <Stream kStream, bool kTurns, bool kLast>
HWY_NOINLINE void pass(const KernelCall& call, const Chunk& chunk, const KernelMap& map,
                       const KernelLink* link, const float* HWY_RESTRICT from, std::size_t stride,
                       float* HWY_RESTRICT state) {
    const D d;
    const Output out(call, kStream == Stream::Positions ? call.positions
                           : kStream == Stream::Normals ? call.normals
                                                        : call.tangents);
    const std::size_t ahead = from == state ? 0 : chunk.blocks * stride;
    const MapRows rows(map);
    const bool adjusted = kTurns && kStream == Stream::Positions && call.isAdjusted(*link);
    const bool scaled = !kTurns && kStream == Stream::Positions && call.lead->scale() != 1.0f;
    for (std::size_t b = 0; b < chunk.blocks; ++b, from += stride) {
        for (std::size_t row = 0; row < 3; ++row) hwy::Prefetch(from + ahead + row * kBlock);
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const float* at = from + lane;
            const std::size_t v = b * kBlock + lane;
            V x = hn::Load(d, at), y = hn::Load(d, at + kBlock), z = hn::Load(d, at + 2 * kBlock);
            if (kTurns) {
                rotate2D(hn::Load(d, chunk.twistSine + v), hn::Load(d, chunk.twistCosine + v), x,
                         y);
                rotate2D(hn::Load(d, chunk.bendSine + v), hn::Load(d, chunk.bendCosine + v), y, z);
                if (HWY_UNLIKELY(adjusted))
                    adjust(call, *link, hn::Load(d, chunk.ratios + b * chunk.ratioStride + lane), x,
                           y, z);
            } else if (HWY_UNLIKELY(scaled)) {
                scaleBy(constant(call.lead->scale()), x, y, z);
            }
            kStream == Stream::Positions ? applyTo(rows, x, y, z) : turnBy(rows, x, y, z);
            if (!kLast) {
                float* to = state + 3 * b * kBlock + lane;
                hn::Store(x, d, to);
                hn::Store(y, d, to + kBlock);
                hn::Store(z, d, to + 2 * kBlock);
            } else if (kStream == Stream::Tangents) {
                const float* w = tangentLanes(call, chunk.first + v) + 3 * kBlock;
                store(out, chunk.first + v, x, y, z, hn::Load(d, w));
            } else {
                store(out, chunk.first + v, x, y, z);
            }
        }
    }
}

template <Stream kStream>
HWY_INLINE void pass(const KernelCall& call, const Chunk& chunk, const KernelMap& map,
                     const KernelLink* link, bool last, ChunkStream& stream) {
    const auto run = link ? (last ? pass<kStream, true, true> : pass<kStream, true, false>)
                          : (last ? pass<kStream, false, true> : pass<kStream, false, false>);
    run(call, chunk, map, link, stream.from, stream.stride, stream.state);
    stream.useState();
}

HWY_INLINE void storeRows(V x, V y, V z, float* HWY_RESTRICT to) {
    const D d;
    hn::Store(x, d, to);
    hn::Store(y, d, to + kBlock);
    hn::Store(z, d, to + 2 * kBlock);
}

/// Adds correctives to a chunk's rest positions.
inline HWY_NOINLINE void correctChunk(const KernelCall& call, const Chunk& chunk,
                                      ChunkStream& stream) {
    const D d;
    const float* HWY_RESTRICT from = stream.from;
    float* HWY_RESTRICT to = stream.state;
    for (std::size_t b = 0; b < chunk.blocks; ++b, from += stream.stride, to += 3 * kBlock)
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            V x = hn::Load(d, from + lane), y = hn::Load(d, from + kBlock + lane),
              z = hn::Load(d, from + 2 * kBlock + lane);
            correct(call, chunk.first + b * kBlock + lane, x, y, z);
            storeRows(x, y, z, to + lane);
        }
    stream.useState();
}

/// The same for rest normals and tangents.
template <bool kTangents>
HWY_NOINLINE void correctDirections(const KernelCall& call, const Chunk& chunk,
                                    ChunkStream& normals, ChunkStream& tangents) {
    const D d;
    for (std::size_t b = 0; b < chunk.blocks; ++b)
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const float* n = normals.from + b * normals.stride + lane;
            V nx = hn::Load(d, n), ny = hn::Load(d, n + kBlock), nz = hn::Load(d, n + 2 * kBlock);
            V tx = hn::Zero(d), ty = tx, tz = tx;
            const float* t = kTangents ? tangents.from + b * tangents.stride + lane : nullptr;
            if (kTangents) {
                tx = hn::Load(d, t);
                ty = hn::Load(d, t + kBlock);
                tz = hn::Load(d, t + 2 * kBlock);
            }
            correctNormals<kTangents>(call, chunk.first + b * kBlock + lane, nx, ny, nz, tx, ty,
                                      tz);
            storeRows(nx, ny, nz, normals.state + 3 * b * kBlock + lane);
            if (kTangents) storeRows(tx, ty, tz, tangents.state + 3 * b * kBlock + lane);
        }
    normals.useState();
    if (!kTangents) return;
    tangents.useState();
}

/// Computes the directions along a chunk's skin at rest.
template <bool kTangents>
HWY_NOINLINE void startSurface(const KernelCall& call, const Chunk& chunk,
                               const ChunkStream& normals, const ChunkStream& tangents,
                               ChunkSurface& surface) {
    const D d;
    for (std::size_t b = 0; b < chunk.blocks; ++b)
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const std::size_t v = b * kBlock + lane;
            const float* n = normals.from + b * normals.stride + lane;
            V ux, uy, uz, vx, vy, vz;
            skinDirections(call, chunk.first + v, hn::Load(d, n), hn::Load(d, n + kBlock),
                           hn::Load(d, n + 2 * kBlock), ux, uy, uz, vx, vy, vz);
            if (kTangents) {
                const float* t = tangents.from + b * tangents.stride + lane;
                const V tx = hn::Load(d, t), ty = hn::Load(d, t + kBlock),
                        tz = hn::Load(d, t + 2 * kBlock);
                hn::Store(dot(tx, ty, tz, ux, uy, uz), d, surface.alongU + v);
                hn::Store(dot(tx, ty, tz, vx, vy, vz), d, surface.alongV + v);
                hn::Store(dot(tx, ty, tz, tx, ty, tz), d, surface.square + v);
            }
            if (call.lead && HWY_UNLIKELY(call.lead->scale() != 1.0f)) {
                scaleBy(constant(call.lead->scale()), ux, uy, uz);
                scaleBy(constant(call.lead->scale()), vx, vy, vz);
            }
            storeRows(ux, uy, uz, surface.u.state + 3 * b * kBlock + lane);
            storeRows(vx, vy, vz, surface.v.state + 3 * b * kBlock + lane);
        }
    surface.u.useState();
    surface.v.useState();
}

/// Takes a direction along the skin through a link, without the map behind it; before the
/// positions.
template <SlopeRow kBend, SlopeRow kTwist>
HWY_NOINLINE void passDirection(const KernelCall& call, const Chunk& chunk, const KernelLink& link,
                                const ChunkStream& positions, ChunkStream& direction) {
    const D d;
    const float &bendSlope = call.bendSlopes[link.joint],
                &twistSlope = call.twistSlopes[link.joint];
    const float* HWY_RESTRICT from = positions.from;
    const std::int16_t* HWY_RESTRICT slopes = chunk.slopes;
    float* HWY_RESTRICT to = direction.state;
    for (std::size_t b = 0; b < chunk.blocks;
         ++b, from += positions.stride, slopes += chunk.slopeStride, to += 3 * kBlock)
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const std::size_t v = b * kBlock + lane;
            V x = hn::Load(d, from + lane), y = hn::Load(d, from + kBlock + lane),
              z = hn::Load(d, from + 2 * kBlock + lane);
            V ux = hn::Load(d, to + lane), uy = hn::Load(d, to + kBlock + lane),
              uz = hn::Load(d, to + 2 * kBlock + lane);
            V sine = hn::Load(d, chunk.twistSine + v), cosine = hn::Load(d, chunk.twistCosine + v);
            if (call.isTiltedByTwist(link))
                addSlope(slopeAt(slopes + lane, kTwist, twistSlope), x, y, ux, uy);
            rotate2D(sine, cosine, x, y);
            rotate2D(sine, cosine, ux, uy);
            sine = hn::Load(d, chunk.bendSine + v);
            cosine = hn::Load(d, chunk.bendCosine + v);
            if (call.isTiltedByBend(link))
                addSlope(slopeAt(slopes + lane, kBend, bendSlope), y, z, uy, uz);
            rotate2D(sine, cosine, uy, uz);
            if (HWY_UNLIKELY(call.isAdjusted(link))) {
                rotate2D(sine, cosine, y, z);
                adjustAlong(call, link, hn::Load(d, chunk.ratios + b * chunk.ratioStride + lane),
                            slopeAt(slopes + lane, kBend, call.slopeUnit), x, y, z, ux, uy, uz);
            }
            storeRows(ux, uy, uz, to + lane);
        }
}

/// Computes normals and tangents from the directions along the skin, behind the last link that
/// tilts them.
/// \param scaled whether joints may be scaled
template <bool kTangents>
HWY_NOINLINE void crossChunk(const Chunk& chunk, const ChunkSurface& surface, bool scaled,
                             ChunkStream& normals, ChunkStream& tangents) {
    const D d;
    for (std::size_t b = 0; b < chunk.blocks; ++b)
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const std::size_t v = b * kBlock + lane, at = 3 * b * kBlock + lane;
            const float* a = surface.u.state + at;
            V ux = hn::Load(d, a), uy = hn::Load(d, a + kBlock), uz = hn::Load(d, a + 2 * kBlock);
            a = surface.v.state + at;
            V vx = hn::Load(d, a), vy = hn::Load(d, a + kBlock), vz = hn::Load(d, a + 2 * kBlock);
            if (HWY_UNLIKELY(scaled)) bringIntoRange(ux, uy, uz, vx, vy, vz);
            V nx, ny, nz;
            cross(ux, uy, uz, vx, vy, vz, nx, ny, nz);
            scaleBy(inverseRoot(dot(nx, ny, nz, nx, ny, nz)), nx, ny, nz);
            storeRows(nx, ny, nz, normals.state + at);
            if (!kTangents) continue;
            combine(hn::Load(d, surface.alongU + v), hn::Load(d, surface.alongV + v), ux, uy, uz,
                    vx, vy, vz, nx, ny, nz);
            scaleBy(hn::Mul(hn::Sqrt(hn::Load(d, surface.square + v)),
                            inverseRoot(dot(nx, ny, nz, nx, ny, nz))),
                    nx, ny, nz);
            storeRows(nx, ny, nz, tangents.state + at);
        }
    normals.useState();
    tangents.useState();
}

/// Deforms a group link by link, a chunk of vertices at a time.
///
/// With 16 registers and no fused multiply-add, this is a quarter faster than taking each vertex
/// through its whole chain, since short loops over many vertices overlap better. Elsewhere it is
/// slower, because of the memory traffic in between.
inline void deformByLinks(const KernelCall& call) {
    const std::size_t blockFloats = SkinBlocks::rowsPerBlock(call.linkCount) * kBlock;
    Chunk chunk;
    ChunkStream positions, normals, tangents;
    chunk.ratioStride = blockFloats;
    ChunkSurface surface;
    bool alongSkin = false; // whether normals and tangents are still directions along the skin
    const auto streams = [&](const KernelMap& map, const KernelLink* link, bool last) HWY_ATTR {
        const KernelLink* turned = link; // for normals and tangents
        if (alongSkin) {
            if (link) {
                passDirection<kBendAlongU, kTwistAlongU>(call, chunk, *link, positions, surface.u);
                passDirection<kBendAlongV, kTwistAlongV>(call, chunk, *link, positions, surface.v);
            }
            turned = nullptr;
        }
        pass<Stream::Positions>(call, chunk, map, link, last, positions);
        if (alongSkin && link != call.links + call.lastSlope) {
            pass<Stream::Normals>(call, chunk, map, nullptr, false, surface.u);
            pass<Stream::Normals>(call, chunk, map, nullptr, false, surface.v);
            return;
        }
        if (alongSkin)
            (call.tangents ? crossChunk<true> : crossChunk<false>)(chunk, surface,
                                                                   call.joints->anyAdjusted,
                                                                   normals, tangents);
        alongSkin = false;
        if (call.normals) pass<Stream::Normals>(call, chunk, map, turned, last, normals);
        if (call.tangents) pass<Stream::Tangents>(call, chunk, map, turned, last, tangents);
    };
    for (chunk.first = 0; chunk.first < call.vertexCount; chunk.first += kChunk) {
        const std::size_t left = (call.vertexCount - chunk.first + kBlock - 1) / kBlock;
        chunk.blocks = HWY_MIN(kChunkBlocks, left);
        const float* rows = call.rows->lane + chunk.first / kBlock * blockFloats;
        positions.from = rows;
        normals.from = rows + 3 * kBlock;
        positions.stride = normals.stride = blockFloats;
        tangents.from = call.tangents ? tangentLanes(call, chunk.first) : nullptr;
        tangents.stride = SkinBlocks::kTangentRows * kBlock;
        chunk.ratios = rows + 6 * kBlock;
        if (HWY_UNLIKELY(call.correctionCount > 0)) {
            correctChunk(call, chunk, positions);
            if (call.normals && !call.gradients)
                (call.tangents ? correctDirections<true>
                               : correctDirections<false>)(call, chunk, normals, tangents);
        }
        alongSkin = call.gradients != nullptr;
        if (alongSkin) {
            chunk.slopes = gradientLanes(call, chunk.first);
            chunk.slopeStride = GradientBlocks::rowsPerBlock(call.linkCount) * kBlock;
            (call.tangents ? startSurface<true> : startSurface<false>)(call, chunk, normals,
                                                                       tangents, surface);
        }

        bool inJointFrame = !call.lead;
        if (call.lead) streams(*call.lead, nullptr, call.linkCount == 0);
        for (std::size_t l = call.linkCount; l-- != 0;
             chunk.ratios += 2 * kBlock, inJointFrame = false) {
            const KernelLink* const link = call.links + l;
            const auto twist = inJointFrame ? turnShares<true> : turnShares<false>;
            twist(call.joints->twistOf(link->joint), call, *link, chunk, chunk.ratios + kBlock,
                  chunk.twistSine, chunk.twistCosine);
            turnShares<false>(call.joints->bendOf(link->joint), call, *link, chunk, chunk.ratios,
                              chunk.bendSine, chunk.bendCosine);
            streams(call.outs[link->out], link, link == call.links);
            if (call.gradients) chunk.slopes += kSlopeRows * kBlock;
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
