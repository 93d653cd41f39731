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

} // namespace test
