// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Blending.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace quality {

/// A mesh as a smooth surface: dense samples of curved triangles (Phong tessellation, Boubekeur and
/// Alexa 2008, by one half, which is exact to second order). Metres.
class SampledSurface {
public:
    SampledSurface(const compare::Points& points, const std::vector<std::uint32_t>& triangles);
    SampledSurface(SampledSurface&&) noexcept;
    ~SampledSurface();

    struct Nearest {
        double distance = 0.0; ///< positive outside
        glm::dvec3 position{0.0}, normal{0.0};
    };
    /// The nearest surface that faces within 90 degrees of `normal`, if there is any nearby.
    Nearest nearest(const glm::dvec3& point, const glm::dvec3& normal) const;

    /// How well points on the surface can be seen from around it: 0 if from nowhere, 1 if from at
    /// least two fifths of all directions.
    std::vector<double> visibility(const compare::Points& points) const;

private:
    struct Tree;
    compare::Points _samples, _normals;
    std::unique_ptr<Tree> _tree;
};

/// A third of the area of each vertex's triangles.
std::vector<double> vertexAreas(const compare::Points& points,
                                const std::vector<std::uint32_t>& triangles);

} // namespace quality
