// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_NEARESTPOINTS_H
#define OSGSKINBIND_NEARESTPOINTS_H

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// For each of some points the nearest of some others; of equally near ones that with the lowest
/// index.
///
/// \param points positions in one space
/// \param candidates indices into `points`, each once; not empty
/// \param queries indices into `points`
/// \return one of the candidates for each query
std::vector<std::uint32_t> nearestPoints(const std::vector<glm::dvec3>& points,
                                         const std::vector<std::uint32_t>& candidates,
                                         const std::vector<std::uint32_t>& queries);

} // namespace osgSkin

#endif
