// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinMotion/ClipCharacter>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <array>

namespace osgSkin {

/// A foot of the rest pose, in a space with Z up.
struct RestFoot {
    osg::Vec3d ankle, ball; ///< joints; without one, where the ball of the foot is
    osg::Vec3d heel, tip;   ///< the ends of the sole, at its height
};

/// Finds `heel` and `tip` of both feet by the vertices of the rest pose.
///
/// \param character its skins and rigid parts
/// \param toSpace from rest space to that of the feet
/// \param forward unit, level
/// \param leg its length
/// \param feet with ankles and balls
void measureSoles(const ClipCharacter& character, const osg::Matrixd& toSpace,
                  const osg::Vec3d& forward, double leg, std::array<RestFoot, 2>& feet);

} // namespace osgSkin
