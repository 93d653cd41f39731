// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace fuzz {

/// A GLB file from its parts: JSON, a byte 0, and the binary chunk. Random changes would break a
/// real file's lengths, and readers would stop there. Input that does not begin like JSON is used
/// unchanged.
class GlbParts {
public:
    static std::string file(const std::uint8_t* data, std::size_t size) {
        std::string bytes(reinterpret_cast<const char*>(data), size);
        if (bytes.empty() || bytes[0] != '{') return bytes;
        const std::size_t end = bytes.find('\0');
        std::string made = chunk(bytes.substr(0, end), "JSON", ' ');
        if (end != std::string::npos)
            made += chunk(bytes.substr(end + 1), std::string("BIN\0", 4), '\0');
        return "glTF" + word(2) + word(12 + made.size()) + made;
    }

private:
    static std::string chunk(std::string bytes, const std::string& type, char padding) {
        bytes.resize((bytes.size() + 3) / 4 * 4, padding);
        return word(bytes.size()) + type + bytes;
    }
    static std::string word(std::size_t value) {
        const auto stored = static_cast<std::uint32_t>(value);
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &stored, 4);
        return bytes;
    }
};

} // namespace fuzz
