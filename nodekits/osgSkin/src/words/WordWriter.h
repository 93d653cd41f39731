// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace osgSkin {

/// Puts numbers and text into 32-bit words, every number with all its bits.
class WordWriter {
public:
    std::vector<std::uint32_t> words;

    void put(std::uint32_t word) { words.push_back(word); }
    void put(std::size_t count) { words.push_back(static_cast<std::uint32_t>(count)); }
    void put(float value) {
        std::uint32_t word;
        std::memcpy(&word, &value, sizeof word);
        words.push_back(word);
    }
    void put(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        words.push_back(static_cast<std::uint32_t>(bits));
        words.push_back(static_cast<std::uint32_t>(bits >> 32));
    }
    template <typename Vector>
    void putVector(const Vector& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put(const std::string& text) {
        put(text.size());
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (i % 4 == 0) words.push_back(0);
            words.back() |= std::uint32_t{static_cast<unsigned char>(text[i])} << (8 * (i % 4));
        }
    }
};

} // namespace osgSkin
