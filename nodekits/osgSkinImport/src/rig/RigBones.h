// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_RIGBONES_H
#define OSGSKINIMPORT_RIGBONES_H 1

#include "assimp/SceneSkeleton.h"

#include <osg/ref_ptr>
#include <osgAnimation/Skeleton>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace osgSkin {

/// A matrix without shear, in its parts: matrix = translation * rotation * scale.
struct NodeTransform {
    glm::dvec3 translation;
    glm::dquat rotation;
    glm::dvec3 scale; ///< the first is negative where the matrix mirrors
};

NodeTransform decompose(const glm::dmat4& matrix);

/// Builds the bones of a scene's joints in their nodes' pose. What clips move gets the elements
/// "translate", "quaternion" and "scale"; other bones hold their matrix.
/// \param moves whether some clip moves the joint, one a joint
osg::ref_ptr<osgAnimation::Skeleton> makeBones(const SceneSkeleton& joints,
                                               const std::vector<bool>& moves);

} // namespace osgSkin

#endif
