// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace compare {

/// A vertex's share in one joint's matrix.
struct JointWeight {
    std::uint32_t joint = 0;
    double weight = 0.0;
};

/// Classic skinning weights, as painted or computed: what linear blending and dual quaternions
/// need.
///
/// Vertex v owns entries[first[v]] up to entries[first[v + 1]]. Weights are at least 0 and sum
/// to 1.
struct SkinWeights {
    std::vector<std::uint32_t> first{0}; ///< size: vertices + 1
    std::vector<JointWeight> entries;

    std::size_t vertexCount() const { return first.size() - 1; }

    /// Adds a vertex after the ones there are. Weights of 0 are left out.
    void add(const std::vector<JointWeight>& vertex);

    /// \throw std::invalid_argument where offsets do not fit, a joint is not below `joints`, a weight
    ///        is negative or not finite, or a vertex's weights do not sum to 1 (to 1e-6)
    void validate(std::size_t joints) const;
};

/// `points` each moved by its own matrix.
/// \throw std::invalid_argument where the counts differ
std::vector<glm::dvec3> transformPoints(const std::vector<glm::dmat4>& matrices,
                                        const std::vector<glm::dvec3>& points);

} // namespace compare
