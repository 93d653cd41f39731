// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MIRROREDTURN_H
#define OSGSKINIMPORT_MIRROREDTURN_H 1

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace osgSkin {

/// How axes stand that negative scales above them may have mirrored: along x, and turned then, as
/// rotationOf() tells it of a matrix.
struct ReflectedRotation {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    bool isMirrored = false;

    /// Those of a node below that is turned, and mirrored along its own axes where its scale is
    /// negative.
    ReflectedRotation below(const glm::dquat& turn, const glm::dvec3& scale) const;
};

} // namespace osgSkin

#endif
