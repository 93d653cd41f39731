// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <cstdint>
#include <vector>

namespace quality {

/// A point of an edge of the skin.
struct EdgePoint {
    std::uint32_t from, to;
    double share; ///< of the way from one to the other
};

/// The loop that a plane cuts out of the rest skin, of several the one nearest to `centre`; empty
/// where the plane cuts nothing.
std::vector<EdgePoint> crossSection(const Subject& subject, const glm::dvec3& centre,
                                    const glm::dvec3& normal);

} // namespace quality
