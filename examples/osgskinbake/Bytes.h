// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <cstring>
#include <string>

namespace bake {

/// Numbers in little-endian order, whatever the machine's is.
class Bytes {
public:
    void add(std::uint8_t value) { data += static_cast<char>(value); }
    void add(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) data += static_cast<char>(value >> shift & 255);
    }
    void add(std::int32_t value) { add(static_cast<std::uint32_t>(value)); }
    void add(float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        add(bits);
    }
    void add(const glm::dvec3& v) {
        add(static_cast<float>(v.x));
        add(static_cast<float>(v.y));
        add(static_cast<float>(v.z));
    }

    std::string data;
};

/// \throw osgSkin::Error where the file cannot be written
void writeBytes(const std::string& file, const std::string& data);

} // namespace bake
