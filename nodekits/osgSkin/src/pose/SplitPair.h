// SPDX-License-Identifier: MIT
#pragma once

#include "pose/PoseAccess.h"

#include <osgSkin/GlmTypes>

namespace osgSkin {

/// A rotation's bend and twist, with the bend axis as the cosine and sine of its angle from e1
/// towards e2 of the joint's Rest.
struct SplitAngles {
    double bend, twist;
    double azimuthCosine, azimuthSine;
};

/// splitUnit() for two joints at once.
///
/// \param q finite unit quaternions of both
/// \param rest the joints'
/// \param angles what both are
void splitPair(const glm::dquat* const (&q)[2], const PoseAccess::Rest* const (&rest)[2],
               SplitAngles (&angles)[2]) noexcept;

} // namespace osgSkin
