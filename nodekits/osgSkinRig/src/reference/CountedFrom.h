// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Motion>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// The same motion with its rotations counted from another pose, which becomes the zero pose of its
/// skeleton.
/// \param motion as it is
/// \param world rotations of its joints in that pose, from its zero pose, one for each
/// \param root position of the root joint there
Motion countedFrom(const Motion& motion, const std::vector<glm::dquat>& world,
                   const glm::dvec3& root);

} // namespace osgSkin
