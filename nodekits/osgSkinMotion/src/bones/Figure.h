// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <string>

namespace osgSkin {

/// A character as attachments need it, found below its root.
struct Figure {
    std::string label; ///< begins its errors: what is attached, and the root's name
    osg::ref_ptr<osgAnimation::Skeleton> skeleton;
    osg::Matrixd toWorld; ///< from rest space to the space of the root's parent

    [[noreturn]] void fail(const std::string& what) const;
};

/// The first skeleton at or below a node that is in no other one; null where there is none.
osgAnimation::Skeleton* skeletonBelow(osg::Node& root);

/// The topmost bone whose callbacks act when all other bones are posed.
/// \throw osgSkin::Error where there is none
osgAnimation::Bone& topBoneOf(const Figure& figure);

/// \param what is to be attached, for errors
/// \throw osgSkin::Error where there is no skeleton below the root, or several side by side
Figure findFigure(osg::Node& root, const std::string& what);

} // namespace osgSkin
