// SPDX-License-Identifier: MIT
#pragma once

#include "Primitives.h"

#include <glm/vec3.hpp>

#include <vector>

namespace mannequin {

/// Edges inside the bounds have this length in metres.
struct DetailRegion {
    RoundCone bounds; ///< on the left side or in the middle; the right side mirrors it
    double edgeLength;
};

/// Target edge length of the skin: short in some regions, growing with the distance from them.
class DetailMap {
public:
    /// \param plain length far from all regions
    DetailMap(double plain, std::vector<DetailRegion> regions);

    /// Edge length in metres, before it is scaled to reach the number of vertices.
    double edgeLength(const glm::dvec3& point) const;

private:
    double _plain;
    std::vector<DetailRegion> _regions;
};

/// The detail of a bare body: face, hands, toes and joints.
DetailMap bareDetail();

} // namespace mannequin
