// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace osgSkin {

/// The turns that all vertices of one group go through, for one pose.
///
/// full[0] partial[0] full[1] partial[1] ... full[n], outermost first: the runs of joints that the
/// group follows fully are folded into one map each, so only partial joints cost work at a
/// vertex.
struct Chain {
    struct Rigid {
        glm::mat3 rotation;
        glm::vec3 offset;
        float scale;

        glm::vec3 operator*(const glm::vec3& x) const { return scale * (rotation * x) + offset; }
    };

    struct Partial {
        glm::vec3 centre;
        glm::vec3 translation;
        glm::vec3 bendAxis;  ///< v
        glm::vec3 twistAxis; ///< w
        glm::vec3 crossAxis; ///< v x w
        float halfBend;      ///< psi / 2
        float halfTwist;     ///< phi / 2
        float growth;        ///< scale - 1
    };

    Chain(const SkinModel& model, const SkinModel::Group& group, const Pose& pose) noexcept;

    /// Poses one vertex; `ratios` has one entry per partial joint. The directions may be null.
    void apply(const SkinModel::Ratio* ratios, glm::vec3& position, glm::vec3* normal,
               glm::vec3* tangent = nullptr) const noexcept;

    std::size_t partialCount = 0;
    std::array<Rigid, SkinModel::kMaxPartialInfluences + 1> full;
    std::array<Partial, SkinModel::kMaxPartialInfluences> partial;
};

} // namespace osgSkin
