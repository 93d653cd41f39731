// SPDX-License-Identifier: MIT
#pragma once

#include "pose/LinkTilt.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// Normals and tangents of the deformed surface, for one group in one pose, plainly and in double
/// precision: what the kernel is compared with.
///
/// Two directions along the skin go through the chain: of a vertex at x, a link with the ratios a
/// makes of a direction d along the skin D(a) d + (dD/da)(x) (grad a . d). What they span is the
/// deformed surface; correctives tilt it at rest.
class SurfaceChain {
public:
    /// \pre the model has gradients
    SurfaceChain(const SkinModel& model, std::size_t group, const Pose& pose) noexcept;

    /// Whether any link of the group tilts normals in this pose; else they turn as vertices do.
    bool tilts() const noexcept { return _tilts; }

    /// Poses directions; on entry those at rest.
    ///
    /// \param row of the group
    /// \param ratios one entry per partial joint
    /// \param position where the chain takes the vertex from, with correctives
    /// \param normal changed
    /// \param tilt what correctives add to the normal
    /// \param tangent changed; may be null
    void apply(std::uint32_t row, const SkinModel::Ratio* ratios, const glm::dvec3& position,
               glm::vec3& normal, const glm::dvec3& tilt, glm::vec3* tangent) const noexcept;

private:
    const SkinModel& _model;
    std::size_t _group;
    const Pose& _pose;
    std::array<LinkTilt, SkinModel::kMaxPartialInfluences> _links;
    bool _tilts = false;
    glm::dmat3 _frame; ///< of the group's blocks
};

/// Adds what correctives add to a rest normal, which keeps its length, and keeps its tangent
/// upright.
void tiltNormal(const glm::dvec3& tilt, glm::vec3& normal, glm::vec3& tangent) noexcept;

} // namespace osgSkin
