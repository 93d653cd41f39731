// SPDX-License-Identifier: MIT
#include <osgSkin/GlmOsg>
#include <osgSkinImport/Prop>

#include <osgAnimation/Channel>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>

namespace osgSkin {
namespace {

template <typename Channel>
osg::ref_ptr<Channel> addChannel(osgAnimation::Animation& animation, const std::string& target,
                                 const std::string& element) {
    osg::ref_ptr<Channel> channel = new Channel;
    channel->setTargetName(target);
    channel->setName(element);
    animation.addChannel(channel);
    return channel;
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

    const auto places = addChannel<osgAnimation::Vec3LinearChannel>(animation, name, "translate");
    const auto turns =
        addChannel<osgAnimation::QuatSphericalLinearChannel>(animation, name, "quaternion");
    auto& placeKeys = *places->getOrCreateSampler()->getOrCreateKeyframeContainer();
    auto& turnKeys = *turns->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (std::size_t frame = 0; frame < way.frames; ++frame) {
        const double time = static_cast<double>(frame) * way.frameTime;
        const glm::dvec3 place = report.scale * way.rootPositions[frame] + report.offset;
        placeKeys.push_back({time, osg::Vec3(toOsg(place))});
        turnKeys.push_back({time, toOsg(way.rotation(frame, 0))});
    }
    return node;
}

} // namespace osgSkin
