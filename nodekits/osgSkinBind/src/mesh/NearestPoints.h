// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinBind/Export>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Finds the nearest candidate for each query; among equally near ones, the one with the lowest
/// index.
///
/// \param points positions in one space
/// \param candidates indices into `points`, each once; not empty
/// \param queries indices into `points`
/// \return one of the candidates for each query
OSGSKINBIND_EXPORT std::vector<std::uint32_t>
nearestPoints(const std::vector<glm::dvec3>& points, const std::vector<std::uint32_t>& candidates,
              const std::vector<std::uint32_t>& queries);

} // namespace osgSkin
