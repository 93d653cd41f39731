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

/// Throws where the file is no JSON.
nlohmann::json readJson(const std::string& file);

/// The number at a place in little-endian bytes.
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

/// A .glb file, its two chunks apart.
struct Glb {
    explicit Glb(const std::string& file);

    /// The bytes of a buffer view.
    std::string view(std::size_t index) const;
    /// The bytes of an accessor, which must be as many as its type takes.
    std::string data(std::size_t index) const;
    std::vector<float> floats(std::size_t accessor) const;
    std::vector<glm::dvec3> vectors(std::size_t accessor) const;

    nlohmann::json json;
    std::string binary;
};

/// Whether Khronos' own validator is there (cmake/gltf_validator.sh), or why not.
bool hasGlbValidator(std::string& why);

/// The errors and warnings that the validator finds in a file, empty where there are none.
std::string glbComplaints(const std::string& file);

} // namespace test
