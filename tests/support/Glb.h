// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace test {

/// A number as four bytes, little-endian, as in a GLB's headers.
inline std::string glbNumber(std::size_t value) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<char>(value >> 8 * k & 0xff));
    return bytes;
}

/// A binary glTF file of a text and, unless empty, the bytes of a buffer. Both are padded.
inline std::string glb(std::string text, std::string bytes = {}, std::size_t version = 2) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    std::string chunks = glbNumber(text.size()) + "JSON" + text;
    if (!bytes.empty()) chunks += glbNumber(bytes.size()) + std::string("BIN\0", 4) + bytes;
    return "glTF" + glbNumber(version) + glbNumber(12 + chunks.size()) + chunks;
}

} // namespace test
