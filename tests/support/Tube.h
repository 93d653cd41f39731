// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>

#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test {

/// A tube along +y from y = 0 to 6, radius 1, over a root at 0, a joint at 2 and one at 4, with
/// ratios that rise along the tube, so that every kind of link (full, partial, none) occurs.
struct Tube {
    osgSkin::Binding binding;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> source;

    explicit Tube(int rings = 25, int sides = 12) {
        const glm::dvec3 y(0, 1, 0);
        binding.joints = {{"root", -1, {0, 0, 0}, y, y},
                          {"middle", 0, {0, 2, 0}, y, y},
                          {"end", 1, {0, 4, 0}, y, y}};
        binding.firstInfluence.push_back(0);
        for (int ring = 0; ring < rings; ++ring)
            for (int side = 0; side < sides; ++side) {
                const double angle = 2.0 * glm::pi<double>() * side / sides;
                const double height = 6.0 * ring / (rings - 1);
                const glm::dvec3 normal(std::cos(angle), 0, std::sin(angle));
                positions.emplace_back(normal + height * y);
                normals.emplace_back(normal);
                source.push_back(static_cast<std::uint32_t>(source.size()));
                bindVertex(height);
            }
    }

    osg::ref_ptr<const osgSkin::SkinModel> model() const {
        return osgSkin::SkinModel::create(binding, positions, normals, source);
    }

private:
    static float rise(double height, double low, double high) {
        const double t = std::fmin(1.0, std::fmax(0.0, (height - low) / (high - low)));
        return static_cast<float>(3.0 * t * t - 2.0 * t * t * t);
    }

    void bindVertex(double height) {
        binding.influences.push_back({0, 1.0f, 1.0f});
        const float middle = rise(height, 1.0, 3.0);
        const float end = rise(height, 3.5, 4.5);
        const float endTwist = rise(height, 2.5, 4.0);
        if (middle > 0.0f) binding.influences.push_back({1, middle, middle});
        if (end > 0.0f || endTwist > 0.0f) binding.influences.push_back({2, end, endTwist});
        binding.regions.push_back(height < 2.0 ? 0 : height < 4.0 ? 1 : 2);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
};

} // namespace test
