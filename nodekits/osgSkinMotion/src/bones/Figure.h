// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/BoneMapVisitor>
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

/// Finds a figure's joints by their names or roles.
class FigureJoints {
public:
    /// \param figure must outlive this
    explicit FigureJoints(const Figure& figure);

    /// Replaces a role by the name of the joint that has it.
    /// \throw osgSkin::Error where no joint is called so, with the likely names
    void resolve(std::string& name);

private:
    const Figure& _figure;
    osgAnimation::BoneMap _bones;
    RestSkeleton _rest; ///< with roles; empty before the first name that is no bone's
    JointRoles _roles;
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
