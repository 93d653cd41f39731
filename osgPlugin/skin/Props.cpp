// SPDX-License-Identifier: GPL-3.0-or-later
#include "Props.h"

#include <osgSkin/GlmOsg>
#include <osgSkinImport/Motion>

#include <osg/MatrixTransform>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>
#include <osgDB/FileNameUtils>

namespace osgSkin {
namespace {

osg::ref_ptr<osg::MatrixTransform> makeNode(const std::string& name, const ImportedMesh& mesh) {
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
    for (const MeshPart& part : mesh.parts) node->addChild(part.geometry);
    return node;
}

void addChannels(const std::string& name, const Motion& way, const RetargetReport& report,
                 osgAnimation::Animation& animation) {
    const osg::ref_ptr<osgAnimation::Vec3LinearChannel> places =
        new osgAnimation::Vec3LinearChannel;
    const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> turns =
        new osgAnimation::QuatSphericalLinearChannel;
    places->setTargetName(name);
    places->setName("translate");
    turns->setTargetName(name);
    turns->setName("quaternion");
    auto& placeKeys = *places->getOrCreateSampler()->getOrCreateKeyframeContainer();
    auto& turnKeys = *turns->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (std::size_t frame = 0; frame < way.frames; ++frame) {
        const double time = static_cast<double>(frame) * way.frameTime;
        const glm::dvec3 place = report.scale * way.rootPositions[frame] + report.offset;
        placeKeys.push_back({time, osg::Vec3(toOsg(place))});
        turnKeys.push_back({time, toOsg(way.rotation(frame, 0))});
    }
    animation.addChannel(places);
    animation.addChannel(turns);
}

} // namespace

void addProps(const SkinFile& file, const Character::Motion& motion, osg::Group& parent,
              osgAnimation::Animation& animation, const osgDB::Options* options) {
    for (std::size_t i = 0; i < file.props.size(); ++i) {
        const SkinFile::Prop& prop = file.props[i];
        if (prop.motion != motion.clip.name) continue;
        std::size_t skip = 0;
        for (const SkinFile::Motion& entry : file.motions)
            if (entry.name == prop.motion) skip = entry.skipFrames;
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        parent.addChild(makeNode(name, importMesh(prop.mesh, options)));
        addChannels(name, importMotion(prop.file, skip), motion.report, animation);
    }
}

} // namespace osgSkin
