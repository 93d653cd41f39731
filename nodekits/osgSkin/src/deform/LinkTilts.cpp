// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, through foreach_target.h; the best is chosen at run time.
#include "deform/DeformKernel.h"

#include "model/GradientBlocks.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/LinkTilts.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;

/// Finds the tilts of 16 links.
HWY_INLINE void findSome(const ChainPlan::Link* links, const GradientBlocks::Reach* reach,
                         const KernelJoints& joints, std::uint16_t& bends, std::uint16_t& twists) {
    const Tag d;
    const hn::Rebind<std::int32_t, Tag> steps;
    const auto least = hn::Set(d, static_cast<float>(LinkTilt::kMin));
    std::uint32_t found[2] = {0, 0};
    for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        static_assert(sizeof *links == sizeof(std::int32_t) && sizeof links->joint == 2);
        const auto both = hn::LoadU(steps, reinterpret_cast<const std::int32_t*>(links + i));
        const auto joint = hn::And(both, hn::Set(steps, 0xffff)); // the one that comes first
        hn::Vec<Tag> bendReach, twistReach;
        hn::LoadInterleaved2(d, &reach[i].bend, bendReach, twistReach);
        const auto tilts = [&](const float* angles, const hn::Vec<Tag>& of) HWY_ATTR {
            const auto angle = hn::Abs(hn::GatherIndex(d, angles, joint));
            std::uint8_t bytes[8] = {}; // the most that may be written
            hn::StoreMaskBits(d, hn::Gt(hn::Mul(angle, of), least), bytes);
            return (bytes[0] | std::uint32_t(bytes[1]) << 8) << i;
        };
        found[0] |= tilts(joints.wholeBend, bendReach);
        found[1] |= tilts(joints.wholeTwist, twistReach);
    }
    bends = static_cast<std::uint16_t>(found[0]);
    twists = static_cast<std::uint16_t>(found[1]);
}

void findTilts(const ChainPlan::Link* links, const GradientBlocks::Reach* reach, std::size_t count,
               const KernelJoints& joints, LinkTilts& to) {
    std::size_t i = 0;
    for (; i + 16 <= count; i += 16)
        findSome(links + i, reach + i, joints, to.bends[i / 16], to.twists[i / 16]);
    if (i < count) {
        ChainPlan::Link lastLinks[16] = {};
        GradientBlocks::Reach lastReach[16] = {};
        std::memcpy(lastLinks, links + i, (count - i) * sizeof *links);
        std::memcpy(lastReach, reach + i, (count - i) * sizeof *reach);
        findSome(lastLinks, lastReach, joints, to.bends[i / 16], to.twists[i / 16]);
        i += 16;
    }
    to.bends[i / 16] = to.twists[i / 16] = 0;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(findTilts);

void LinkTilts::find(const ChainPlan::Link* links, const GradientBlocks::Reach* reach,
                     std::size_t count, const KernelJoints& joints) noexcept {
    HWY_DYNAMIC_DISPATCH(findTilts)(links, reach, count, joints, *this);
}

} // namespace osgSkin
#endif
