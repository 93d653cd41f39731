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
#include "deform/KernelStore-inl.h"
#include "deform/KernelTurns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

enum class Stream { Positions, Normals, Tangents };

/// Vertices that go through a link together; what is kept of them between links stays in the
/// first-level cache.
constexpr std::size_t kChunkBlocks = 8;
constexpr std::size_t kChunk = kChunkBlocks * kBlock;

struct alignas(64) Chunk {
    std::size_t first = 0;         ///< vertex of the group
    std::size_t blocks = 0;        ///< at most kChunkBlocks
    std::size_t ratioStride = 0;   ///< floats from a block's ratios to the next one's
    const float* ratios = nullptr; ///< of the link at hand: bend, behind it twist

    float twistSine[kChunk], twistCosine[kChunk]; ///< of the link at hand
    float bendSine[kChunk], bendCosine[kChunk];
};

/// A stream of a chunk: x, y and z of a block, then of the next one.
struct alignas(64) ChunkStream {
    const float* from = nullptr; ///< in the skin's blocks at first, then in `state`
    std::size_t stride = 0;
    float state[3 * kChunk]; ///< between two links
};

/// Sines and cosines of an angle's shares, as sineCosine() has them; the polynomials are scaled so
/// that they take the shares as they are. With kShifted, the call's azimuth is taken off.
template <int kDoublings, bool kShifted, std::size_t kTerms>
HWY_INLINE void turnShares(const float (&sineTerms)[kTerms], const float (&cosineTerms)[kTerms - 1],
                           float angle, const KernelCall& call, const Chunk& chunk,
                           const float* HWY_RESTRICT ratio, float* HWY_RESTRICT sines,
                           float* HWY_RESTRICT cosines) {
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
            if (kShifted) takeAzimuthOff(call, sine, cosine);
            hn::Store(sine, d, sines + b * kBlock + lane);
            hn::Store(cosine, d, cosines + b * kBlock + lane);
        }
    }
}

template <bool kShifted>
HWY_NOINLINE void turnShares(const KernelAngle& angle, const KernelCall& call, const Chunk& chunk,
                             const float* ratio, float* sines, float* cosines) {
    const float value = angle.value.value[0];
    switch (angle.range) {
    case KernelAngle::kSmall:
        return turnShares<0, kShifted>(kSmallSine, kSmallCosine, value, call, chunk, ratio, sines,
                                       cosines);
    case KernelAngle::kMedium:
        return turnShares<0, kShifted>(kMediumSine, kMediumCosine, value, call, chunk, ratio, sines,
                                       cosines);
    case KernelAngle::kLarge:
        return turnShares<0, kShifted>(kLargeSine, kLargeCosine, value, call, chunk, ratio, sines,
                                       cosines);
    case KernelAngle::kHalved:
        return turnShares<1, kShifted>(kLargeSine, kLargeCosine, value, call, chunk, ratio, sines,
                                       cosines);
    case KernelAngle::kQuartered:
        return turnShares<2, kShifted>(kLargeSine, kLargeCosine, value, call, chunk, ratio, sines,
                                       cosines);
    }
}

/// One stream through a link, or through a map alone; to the output where it is the last.
template <Stream kStream, bool kTurns, bool kLast>
HWY_NOINLINE void pass(const KernelCall& call, const Chunk& chunk, const KernelMap& map,
                       const KernelLink* link, const float* HWY_RESTRICT from, std::size_t stride,
                       float* HWY_RESTRICT state) {
    const D d;
    const Output out(call, kStream == Stream::Positions ? call.positions
                           : kStream == Stream::Normals ? call.normals
                                                        : call.tangents);
    const std::size_t ahead = from == state ? 0 : chunk.blocks * stride;
    for (std::size_t b = 0; b < chunk.blocks; ++b, from += stride) {
        for (std::size_t row = 0; row < 3; ++row) hwy::Prefetch(from + ahead + row * kBlock);
        for (std::size_t lane = 0; lane < kBlock; lane += hn::Lanes(d)) {
            const float* at = from + lane;
            const std::size_t v = b * kBlock + lane;
            V x = hn::Load(d, at), y = hn::Load(d, at + kBlock), z = hn::Load(d, at + 2 * kBlock);
            if (kTurns) {
                turnPlane(hn::Load(d, chunk.twistSine + v), hn::Load(d, chunk.twistCosine + v), x,
                          y);
                turnPlane(hn::Load(d, chunk.bendSine + v), hn::Load(d, chunk.bendCosine + v), y, z);
                if (kStream == Stream::Positions && HWY_UNLIKELY(link->adjusted))
                    adjust(*link, hn::Load(d, chunk.ratios + b * chunk.ratioStride + lane), x, y,
                           z);
            } else if (kStream == Stream::Positions && HWY_UNLIKELY(call.leadScaled)) {
                scaleBy(constant(call.leadScale), x, y, z);
            }
            kStream == Stream::Positions ? apply(map, x, y, z) : turn(map, x, y, z);
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
    stream.from = stream.state;
    stream.stride = 3 * kBlock;
}

/// The chunk's rest positions with their correctives, from where the first link takes them.
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
            hn::Store(x, d, to + lane);
            hn::Store(y, d, to + kBlock + lane);
            hn::Store(z, d, to + 2 * kBlock + lane);
        }
    stream.from = stream.state;
    stream.stride = 3 * kBlock;
}

/// Deforms a group link by link, a chunk of vertices at a time.
///
/// Where there are 16 registers and no fused multiply-add, this is a quarter faster than taking
/// each vertex through its whole chain: the processor finds more to do at the same time in short
/// loops over many vertices. Elsewhere it is slower, because of what goes to memory in between.
HWY_INLINE void deformByLinks(const KernelCall& call) {
    const std::size_t blockFloats = SkinBlocks::rowsPerBlock(call.linkCount) * kBlock;
    Chunk chunk;
    ChunkStream positions, normals, tangents;
    chunk.ratioStride = blockFloats;
    const auto streams = [&](const KernelMap& map, const KernelLink* link, bool last) HWY_ATTR {
        pass<Stream::Positions>(call, chunk, map, link, last, positions);
        if (call.normals) pass<Stream::Normals>(call, chunk, map, link, last, normals);
        if (call.tangents) pass<Stream::Tangents>(call, chunk, map, link, last, tangents);
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
        if (HWY_UNLIKELY(call.correctionCount > 0)) correctChunk(call, chunk, positions);

        bool inJointFrame = !call.lead;
        if (call.lead) streams(*call.lead, nullptr, call.linkCount == 0);
        for (const KernelLink* link = call.links + call.linkCount; link-- != call.links;
             chunk.ratios += 2 * kBlock, inJointFrame = false) {
            const auto twist = inJointFrame ? turnShares<true> : turnShares<false>;
            twist(link->twist, call, chunk, chunk.ratios + kBlock, chunk.twistSine,
                  chunk.twistCosine);
            turnShares<false>(link->bend, call, chunk, chunk.ratios, chunk.bendSine,
                              chunk.bendCosine);
            streams(link->out, link, link == call.links);
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
