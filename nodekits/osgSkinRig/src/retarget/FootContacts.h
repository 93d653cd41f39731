// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Samples first to last, both included, in which a foot is planted.
struct FootContact {
    std::size_t first, last;
};

/// The height that one of the actor's feet stands on: what it goes below in a twentieth of the
/// samples.
/// \param positions of the foot, +y up, [frame]
double standingHeight(const std::vector<glm::dvec3>& positions);

/// Where a foot is planted, as FootSkate says.
/// \param positions of the actor's foot, +y up, [frame]
/// \param frameTime seconds between samples
/// \param floor the height that feet stand on
/// \param leg length of the actor's leg
std::vector<FootContact> findFootContacts(const std::vector<glm::dvec3>& positions,
                                          double frameTime, double floor, double leg);

} // namespace osgSkin
