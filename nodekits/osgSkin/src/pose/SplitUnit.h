// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/BendTwist>

namespace osgSkin {

/// trySplitBendTwist() for what is known to be right: a finite unit quaternion q and a finite unit
/// vector w, both to the last digits.
BendTwist splitUnit(const glm::dquat& q, const glm::dvec3& w) noexcept;

} // namespace osgSkin
