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

/// A face of a twelfth of the vertices, as on characters, in front of all others: `targets` shapes,
/// each of a third of it.
inline osg::ref_ptr<const osgSkin::MorphTargets> faceTargets(std::size_t vertices,
                                                             std::size_t targets) {
    const std::size_t face = vertices / 12;
    std::vector<osgSkin::MorphTarget> result(targets);
    for (std::size_t i = 0; i < targets; ++i) {
        result[i].name = std::to_string(i);
        for (std::size_t k = 0; k < face / 3; ++k) {
            result[i].vertices.push_back(
                static_cast<std::uint32_t>(i * (face - face / 3) / targets + k));
            result[i].positions.emplace_back(0.01f, 0.02f, -0.01f);
            result[i].normals.emplace_back(0.1f, -0.1f, 0.2f);
        }
    }
    return osgSkin::MorphTargets::create(std::move(result), vertices);
}

} // namespace test
