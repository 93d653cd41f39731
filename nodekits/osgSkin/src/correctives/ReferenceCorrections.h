// SPDX-License-Identifier: MIT
#pragma once

#include "correctives/CorrectiveWeights.h"
#include "model/SkinModelAccess.h"

#include <glm/vec3.hpp>

namespace osgSkin {

/// The correctives in one pose, vertex by vertex: what the kernel is compared with.
class ReferenceCorrections {
public:
    /// \pre the model has correctives
    ReferenceCorrections(const SkinModel& model, const Pose& pose) noexcept
        : _blocks(*SkinModelAccess::correctives(model)), _weights(model, pose) {}

    /// Adds what the vertex in a row of a group gets.
    ///
    /// \param group an index
    /// \param row of the group
    /// \param position rest space; changed
    /// \param tilt what its rest normal gets, added to
    void apply(std::size_t group, std::uint32_t row, glm::dvec3& position,
               glm::dvec3& tilt) noexcept;

private:
    const CorrectiveBlocks& _blocks;
    CorrectiveWeights _weights;
};

} // namespace osgSkin
