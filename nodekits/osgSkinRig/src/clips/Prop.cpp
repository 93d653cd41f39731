// SPDX-License-Identifier: MIT
#include <osgSkinRig/Prop>

#include "clips/ClipChannels.h"

#include <osgSkin/GlmOsg>

#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>

namespace osgSkin {
namespace {

/// The prop's way in skeleton space, as a clip of one joint.
Clip makeWay(const Motion& way, const RetargetReport& report) {
    Clip clip;
    clip.frameTime = way.frameTime;
    clip.frames = way.frames;
    clip.joints = 1;
    for (std::size_t frame = 0; frame < way.frames; ++frame) {
        clip.rotations.push_back(report.turn * way.rotation(frame, 0));
        clip.rootPositions.push_back(report.scale * (report.turn * way.rootPositions[frame]) +
                                     report.offset);
    }
    return clip;
}

} // namespace

osg::ref_ptr<osg::MatrixTransform> makeProp(const std::string& name,
                                            const std::vector<MeshPart>& parts, const Motion& way,
                                            const RetargetReport& report,
                                            osgAnimation::Animation& animation) {
    osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
    node->setName(name);
    node->setDataVariance(osg::Object::DYNAMIC);
    const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> update =
        new osgAnimation::UpdateMatrixTransform(name);
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedTranslateElement("translate", osg::Vec3()));
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
    node->setUpdateCallback(update);
    for (const MeshPart& part : parts) node->addChild(part.geometry);

    const Clip clip = makeWay(way, report);
    if (clip.frames > 0) // where it is before the first update
        node->setMatrix(osg::Matrix::rotate(toOsg(clip.rotations[0])) *
                        osg::Matrix::translate(toOsg(clip.rootPositions[0])));
    for (const auto& channel : {rootChannel(clip), rotationChannel(clip, 0)}) {
        channel->setTargetName(name);
        animation.addChannel(channel);
    }
    return node;
}

} // namespace osgSkin
