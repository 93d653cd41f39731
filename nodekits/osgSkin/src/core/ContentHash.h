// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace osgSkin {

/// A hash of bytes, wide enough that two contents with the same one do not occur by chance.
class ContentHash {
public:
    /// Adds bytes and their number.
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        // Four independent products at a time, which a processor overlaps.
        std::uint64_t lanes[4] = {low, ~low, high, ~high}, words[4];
        std::size_t left = size;
        for (; left >= sizeof words; left -= sizeof words, bytes += sizeof words) {
            std::memcpy(words, bytes, sizeof words);
            mix(words, lanes);
        }
        std::memset(words, 0, sizeof words);
        if (left > 0) std::memcpy(words, bytes, left);
        mix(words, lanes);
        for (const std::uint64_t word : {lanes[0], lanes[1], lanes[2], lanes[3], size}) {
            low = step(low, word, 0x9e3779b97f4a7c15u);
            high = step(high, (word << 29) | (word >> 35), 0xc2b2ae3d27d4eb4fu);
        }
    }

    std::uint64_t low = 0x243f6a8885a308d3u, high = 0x13198a2e03707344u;

    friend bool operator==(const ContentHash& a, const ContentHash& b) {
        return a.low == b.low && a.high == b.high;
    }

private:
    static std::uint64_t step(std::uint64_t state, std::uint64_t word, std::uint64_t factor) {
        state = (state ^ word) * factor;
        return state ^ (state >> 31);
    }
    static void mix(const std::uint64_t (&words)[4], std::uint64_t (&lanes)[4]) {
        for (int i = 0; i < 4; ++i) lanes[i] = step(lanes[i], words[i], 0x9fb21c651e98df25u);
    }
};

} // namespace osgSkin
