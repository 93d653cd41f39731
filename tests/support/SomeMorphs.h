// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/MorphTargets>

#include <random>
#include <string>
#include <vector>

namespace test {

/// Three targets of a skin: "smile" moves every third vertex, "frown" the second half without its
/// normals, "open" all vertices and their tangents.
inline std::vector<osgSkin::MorphTarget> someMorphs(std::size_t vertices, double size) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    const auto offset = [&] { return glm::vec3(number(random), number(random), number(random)); };
    std::vector<osgSkin::MorphTarget> result(3);
    const char* const names[] = {"smile", "frown", "open"};
    for (std::size_t i = 0; i < 3; ++i) {
        osgSkin::MorphTarget& target = result[i];
        target.name = names[i];
        for (std::size_t v = i == 1 ? vertices / 2 : 0; v < vertices; v += i == 0 ? 3 : 1) {
            target.vertices.push_back(static_cast<std::uint32_t>(v));
            target.positions.push_back(static_cast<float>(size) * offset());
            if (i != 1) target.normals.push_back(0.3f * offset());
            if (i == 2) target.tangents.push_back(0.2f * offset());
        }
    }
    return result;
}

} // namespace test
