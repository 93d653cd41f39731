// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinMotion/Export>

#include <osg/Matrixd>
#include <osg/NodeCallback>

namespace osgSkin {

/// Sets a bone's matrices to those of a ClipPlayer, after the bone's own callback and before those
/// that were added to it. Files keep it without matrices, and the player that is read finds it.
class OSGSKINMOTION_EXPORT PlacedBone : public osg::NodeCallback {
public:
    PlacedBone() = default;
    PlacedBone(const PlacedBone& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other,
                                                                                      copyop) {}
    META_Object(osgSkinMotion, PlacedBone)

    osg::Matrixd inParent, inSkeleton;
    bool isSet = false; ///< else the bone stays as it is

    void operator()(osg::Node* node, osg::NodeVisitor* nv) override;
};

} // namespace osgSkin
