// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

namespace test {

std::string readBytes(const std::string& file);

/// Throws if the file is not JSON.
nlohmann::json readJson(const std::string& file);

/// The number at an offset in little-endian bytes.
template <typename Number>
Number at(const std::string& bytes, std::size_t offset) {
    Number value{};
    EXPECT_LE(offset + sizeof value, bytes.size());
    if (offset + sizeof value <= bytes.size())
        std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// Three floats.
glm::dvec3 vectorAt(const std::string& bytes, std::size_t offset);

/// A .glb file, split into its two chunks.
struct Glb {
    explicit Glb(const std::string& file);

    /// The bytes of a buffer view.
    std::string view(std::size_t index) const;
    /// The bytes of an accessor; their number must match its type.
    std::string data(std::size_t index) const;
    std::vector<float> floats(std::size_t accessor) const;
    std::vector<glm::dvec3> vectors(std::size_t accessor) const;

    nlohmann::json json;
    std::string binary;
};

/// Whether Khronos' own validator is available (cmake/gltf_validator.sh), or why not.
bool hasGlbValidator(std::string& why);

/// The validator's errors and warnings for a file; empty if there are none.
std::string glbComplaints(const std::string& file);

} // namespace test
