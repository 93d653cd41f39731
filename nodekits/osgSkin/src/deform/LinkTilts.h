// SPDX-License-Identifier: MIT
#pragma once

#include "chains/KernelJoints.h"
#include "model/ChainPlan.h"
#include "model/GradientBlocks.h"

#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// linkTilt() of links that stand side by side, but for what joints' translations and scales do: a
/// bit each.
struct LinkTilts {
    static constexpr std::size_t kMost = 1024;

    /// \param links of joints of the section
    /// \param reach of each of them
    /// \param count at most kMost
    void find(const ChainPlan::Link* links, const GradientBlocks::Reach* reach, std::size_t count,
              const KernelJoints& joints) noexcept;

    std::uint16_t bends[kMost / 16 + 1], twists[kMost / 16 + 1]; ///< and one behind

    /// Those from one link on.
    /// \param count at most SkinModel::kMaxPartialInfluences
    static std::uint32_t some(const std::uint16_t* bits, std::size_t first, std::size_t count) {
        const std::uint32_t from = bits[first / 16] | std::uint32_t(bits[first / 16 + 1]) << 16;
        return from >> first % 16 & ((1u << count) - 1);
    }
};

} // namespace osgSkin
