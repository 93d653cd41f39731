// SPDX-License-Identifier: MIT
#include <osgSkinRig/Prop>

#include "clips/ClipChannels.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>

#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>

namespace osgSkin {
namespace {

/// The prop's motion in skeleton space, as a clip of one joint.
Clip inSkeletonSpace(const Motion& motion, const RetargetReport& report) {
    Clip clip;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = 1;
    for (std::size_t frame = 0; frame < motion.frames; ++frame) {
        clip.rotations.push_back(report.rotation * motion.rotation(frame, 0));
        clip.rootPositions.push_back(
            report.scale * (report.rotation * motion.rootPositions[frame]) + report.offset);
    }
    return clip;
}

} // namespace

osg::ref_ptr<osg::MatrixTransform> makeProp(const std::string& name,
                                            const std::vector<MeshPart>& parts,
                                            const Motion& motion, const RetargetReport& report,
                                            osgAnimation::Animation& animation) {
    motion.validate();
    const Clip clip = inSkeletonSpace(motion, report);
    for (const glm::dvec3& position : clip.rootPositions)
        if (!isInRange(position))
            throw Error("prop \"" + name +
                        "\": a place in the figure's space is not finite, or "
                        "beyond -1e18 to 1e18");
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

    // Where it is before the first update.
    node->setMatrix(osg::Matrix::rotate(toOsg(clip.rotations[0])) *
                    osg::Matrix::translate(toOsg(clip.rootPositions[0])));
    for (const auto& channel : {rootChannel(clip), rotationChannel(clip, 0)}) {
        channel->setTargetName(name);
        animation.addChannel(channel);
    }
    return node;
}

} // namespace osgSkin
