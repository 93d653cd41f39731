// SPDX-License-Identifier: MIT
#include "bounds/BlendedPieces.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace osgSkin {
namespace {

/// How far within the box of all boxes one may end to be among the first, in its size.
constexpr float kFirst = 0.01f;
/// How far out of the box one may reach and be good enough, in its size.
constexpr float kLoose = 0.03f;

Four fourOf(const BoundsProxy::Lanes& lanes, std::size_t first) noexcept {
    Four result;
    std::memcpy(&result, lanes.lane + first, sizeof(result));
    return result;
}

float least(const Four& a) noexcept {
    return std::min(std::min(a[0], a[1]), std::min(a[2], a[3]));
}

} // namespace

BlendedPieces::BlendedPieces(const BoundsProxy& proxy, const JointMotions& motions) noexcept
    : _proxy(proxy) {
    blendBoxes(proxy, motions, _blocks.data());
}

BlendedPieces::Sides BlendedPieces::sidesOf(const Four& low, const Four& high) noexcept {
    return {{all(low[0]), all(low[1]), all(low[2])}, {all(high[0]), all(high[1]), all(high[2])}};
}

unsigned int BlendedPieces::outside(std::size_t block, const Sides& sides) const noexcept {
    const BlendedBlock& of = _blocks[block];
    unsigned int lanes = 0;
    for (unsigned int first = 0; first < BoundsProxy::kAtOnce; first += 4) {
        Four::Mask inside = fourOf(of.low[0], first).v >= sides.low[0].v; // false for NaN
        inside &= fourOf(of.high[0], first).v <= sides.high[0].v;
        for (int axis = 1; axis < 3; ++axis) {
            inside &= fourOf(of.low[axis], first).v >= sides.low[axis].v;
            inside &= fourOf(of.high[axis], first).v <= sides.high[axis].v;
        }
        std::int64_t halves[2];
        std::memcpy(halves, &inside, sizeof(halves));
        if ((halves[0] & halves[1]) == -1) continue;
        for (unsigned int lane = 0; lane < 4; ++lane)
            if (!inside[lane]) lanes |= 1u << (first + lane);
    }
    return lanes;
}

FourBox BlendedPieces::around() const noexcept {
    FourBox box;
    for (int axis = 0; axis < 3; ++axis) {
        Four low = all(std::numeric_limits<float>::max()), high = all(-low[0]);
        for (std::size_t b = 0; b < _proxy.blocks.size(); ++b)
            for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += 4) {
                low = min(low, fourOf(_blocks[b].low[axis], first));
                high = max(high, fourOf(_blocks[b].high[axis], first));
            }
        box.low.v[axis] = least(low);
        box.high.v[axis] = -least({-high.v});
    }
    return box;
}

void BlendedPieces::take(std::size_t block, unsigned int lanes, PosedPieces& pieces,
                         FourBox& box) noexcept {
    const BoundsProxy::Block& of = _proxy.blocks[block];
    for (std::uint32_t lane = 0; lane < BoundsProxy::kAtOnce; ++lane) {
        if ((lanes >> lane & 1u) == 0) continue;
        if (lane < of.pieceCount) pieces.add(_proxy.pieces[of.firstPiece + lane], box);
        for (int axis = 0; axis < 3; ++axis) {
            _blocks[block].low[axis].lane[lane] = std::numeric_limits<float>::max();
            _blocks[block].high[axis].lane[lane] = -std::numeric_limits<float>::max();
        }
    }
}

void BlendedPieces::addTo(PosedPieces& pieces, FourBox& box) noexcept {
    const FourBox most = around();
    const Four inward = kFirst * (most.high - most.low);
    Sides sides = sidesOf(most.low + inward, most.high - inward);
    for (std::size_t b = 0; b < _proxy.blocks.size(); ++b)
        if (const unsigned int lanes = outside(b, sides)) take(b, lanes, pieces, box);
    for (std::size_t b = 0; b < _proxy.blocks.size(); ++b) {
        const Four outward = kLoose * (box.high - box.low);
        sides = sidesOf(box.low - outward, box.high + outward);
        if (const unsigned int lanes = outside(b, sides)) take(b, lanes, pieces, box);
    }
    const FourBox others = around();
    box.low = min(box.low, others.low);
    box.high = max(box.high, others.high);
}

} // namespace osgSkin
