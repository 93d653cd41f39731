// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <glm/vec3.hpp>
#include <osg/Matrixd>
#include <osg/Node>

#include <vector>

namespace osgSkin {

/// Joint centres in the world; not finite for joints that are not found.
using JointCentres = std::vector<glm::dvec3>;

/// The quarter turns after which a figure stands along +Z and faces -Y, towards the camera of OSG's
/// viewers.
///
/// \param roles roles of the joints; if they come from the skeleton's shape, left is not known and
///        nothing is rotated
/// \param centres [joint], world, at rest
/// \param played the same at an animation's start; empty where there is none. The pose in which the
///        figure already stands counts; a figure that lies in only one of them is not stood up
/// \return a rotation; the identity where up and left are unknown
osg::Matrixd orientToFront(const JointRoles& roles, const JointCentres& centres,
                           const JointCentres& played = {});

/// The joints of a rest pose, in the world.
/// \param rest the skeleton
/// \param toWorld from rest space
JointCentres restCentres(const RestSkeleton& rest, const osg::Matrixd& toWorld);

/// The joints in a clip's first sample, in the world.
///
/// \param rest the skeleton
/// \param clip of this skeleton, with a sample at least
/// \param toWorld from the skeleton's space
JointCentres clipCentres(const RestSkeleton& rest, const Clip& clip, const osg::Matrixd& toWorld);

/// The present positions of a scene's bones with the joints' names, in the scene's space.
/// \param rest names the joints
/// \param scene its bones are searched
JointCentres boneCentres(const RestSkeleton& rest, osg::Node& scene);

} // namespace osgSkin
