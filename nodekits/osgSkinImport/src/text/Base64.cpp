// SPDX-License-Identifier: MIT
#include "text/Base64.h"

#include "text/FileText.h"

#include <osgSkin/Error>

#include <array>
#include <cstdint>

namespace osgSkin {
namespace {

constexpr std::string_view kLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The value of a base64 letter; 255 for other bytes.
std::size_t valueOf(char letter) {
    static const std::array<unsigned char, 256> values = [] {
        std::array<unsigned char, 256> result;
        result.fill(255);
        for (std::size_t i = 0; i < kLetters.size(); ++i)
            result[static_cast<unsigned char>(kLetters[i])] = static_cast<unsigned char>(i);
        return result;
    }();
    return values[static_cast<unsigned char>(letter)];
}

} // namespace

std::string fromBase64(std::string_view text) {
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    // Only padding may follow.
    const std::size_t end = text.find_last_not_of("= \t\r\n");
    for (std::size_t i = 0; end != std::string_view::npos && i <= end; ++i) {
        const std::size_t value = valueOf(text[i]);
        if (value >= kLetters.size()) {
            if (std::string_view(" \t\r\n").find(text[i]) != std::string_view::npos) continue;
            throw Error("letter " + std::to_string(i) + " is " + inQuotes(text.substr(i, 1)) +
                        ", expected base64 (A to Z, a to z, 0 to 9, + and /)");
        }
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(bits >> count & 0xffu));
    }
    return bytes;
}

std::string toBase64(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits =
                bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(i + k <= bytes.size() ? kLetters[bits >> (18 - 6 * k) & 63u] : '=');
    }
    return text;
}

} // namespace osgSkin
