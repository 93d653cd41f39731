// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_NEARESTPOINT_H
#define OSGSKINBIND_NEARESTPOINT_H

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Finds the nearest of some points: a balanced k-d tree (Bentley 1975) over indices.
class NearestPoint {
public:
    /// \pre candidates is not empty; `points` outlives this object.
    NearestPoint(const std::vector<glm::dvec3>& points, std::vector<std::uint32_t> candidates);

    /// Index into `points` of the candidate nearest to `p`; of equals the lowest.
    std::uint32_t find(const glm::dvec3& p) const;

private:
    void build(std::size_t begin, std::size_t end, int axis);
    void search(std::size_t begin, std::size_t end, int axis, const glm::dvec3& p,
                std::uint32_t& best, double& bestSquared) const;

    const std::vector<glm::dvec3>& _points;
    std::vector<std::uint32_t> _order; ///< each range's median splits it along the range's axis
};

} // namespace osgSkin

#endif
