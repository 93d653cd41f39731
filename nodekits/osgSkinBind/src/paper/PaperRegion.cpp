// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/PaperRegion.h"

#include "limbs/HermiteRatio.h"
#include "paper/PhiloSegment.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {

double PaperRegion::ratio(const glm::dvec3& p) const {
    const double belowUpper = glm::dot(p - upper.point, upper.normal);
    const double aboveLower = glm::dot(lower.point - p, lower.normal);
    if (belowUpper <= 0.0 && aboveLower >= 0.0) return 0.0;
    if (belowUpper >= 0.0 && aboveLower <= 0.0) return 1.0;
    if (belowUpper < 0.0) return hermiteRatio(aboveLower / (belowUpper + aboveLower));
    // By the arc tangent, since the planes of a straight limb are nearly parallel.
    const double angle = std::atan2(glm::length(glm::cross(upper.normal, lower.normal)),
                                    glm::dot(upper.normal, lower.normal));
    return hermiteRatio(philoShare(belowUpper, aboveLower, angle)); // eq. 5
}

} // namespace osgSkin
