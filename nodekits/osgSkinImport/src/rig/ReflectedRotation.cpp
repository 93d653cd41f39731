// SPDX-License-Identifier: MIT
#include "rig/ReflectedRotation.h"

namespace osgSkin {

ReflectedRotation ReflectedRotation::below(const glm::dquat& turn, const glm::dvec3& scale) const {
    // With F, mirroring along x: F R F is a rotation, too, and so is what is left of the scale's
    // signs, half a turn about an axis or none.
    const glm::dquat own = isMirrored ? glm::dquat(turn.w, turn.x, -turn.y, -turn.z) : turn;
    const bool x = scale.x < 0.0, y = scale.y < 0.0, z = scale.z < 0.0;
    glm::dquat rest(1.0, 0.0, 0.0, 0.0);
    if (y && z) rest = {0.0, 1.0, 0.0, 0.0};
    if (y && !z) rest = {0.0, 0.0, 0.0, 1.0};
    if (!y && z) rest = {0.0, 0.0, 1.0, 0.0};
    return {rotation * own * rest, isMirrored != (x != (y != z))};
}

} // namespace osgSkin
