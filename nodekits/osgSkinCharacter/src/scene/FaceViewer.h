// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec3d>

#include <optional>
#include <vector>

namespace osgSkin {

/// Where joints are in the world; unset for those that are not found.
using JointCentres = std::vector<std::optional<osg::Vec3d>>;

/// The quarter turns after which a figure stands on its feet, along +Z, and looks along -Y: to
/// where OSG's viewers look from.
///
/// \param roles what the joints are; where only the skeleton's shape told, left is not known, and
///        nothing is turned
/// \param centres [joint], world, at rest
/// \param played the same as an animation begins; empty where there is none. Of both poses that one
///        counts in which the figure stands already; a figure that lies in one only is not stood up
/// \return a rotation; the identity where the joints do not tell
osg::Matrixd turnToViewer(const JointRoles& roles, const JointCentres& centres,
                          const JointCentres& played = {});

/// Whether trunk, thighs and shins lie along one axis: such a pose tells which way is up, also
/// where a motion begins on the floor.
///
/// \param roles what the joints are
/// \param centres [joint], world
bool isStraight(const JointRoles& roles, const JointCentres& centres);

/// The joints of a rest pose, put into the world.
/// \param rest the skeleton
/// \param toWorld from rest space
JointCentres restCentres(const RestSkeleton& rest, const osg::Matrixd& toWorld);

/// The joints as a clip begins.
///
/// \param rest the skeleton
/// \param clip of this skeleton, with a sample at least
/// \param toWorld from the skeleton's space
JointCentres clipCentres(const RestSkeleton& rest, const Clip& clip, const osg::Matrixd& toWorld);

/// The joints as a scene's bones of these names stand, as no animation has moved them yet.
/// \param rest whose joints are looked for
/// \param scene from whose space they are told
JointCentres boneCentres(const RestSkeleton& rest, osg::Node& scene);

} // namespace osgSkin
