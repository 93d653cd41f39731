// SPDX-License-Identifier: MIT
#include "SavedScene.h"

#include "Turns.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/GlmOsg>
#include <osgSkin/RigidPart>
#include <osgSkin/UpdateDeformableSkin>

#include <osg/Material>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgDB/Registry>

#include <sstream>

namespace test {
namespace {

osg::ref_ptr<osg::Geometry> makeGeometry(const Tube& tube) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec2Array> texture = new osg::Vec2Array;
    const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        vertices->push_back({tube.positions[v].x, tube.positions[v].y, tube.positions[v].z});
        normals->push_back({tube.normals[v].x, tube.normals[v].y, tube.normals[v].z});
        texture->push_back({tube.positions[v].x, tube.positions[v].y});
        tangents->push_back({0, 1, 0, v % 2 == 0 ? 1.0f : -1.0f});
    }
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, texture, osg::Array::BIND_PER_VERTEX);
    geometry->setVertexAttribArray(6, tangents, osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::DrawElementsUShort> points = new osg::DrawElementsUShort(GL_POINTS);
    for (unsigned int v = 0; v < vertices->size(); ++v) points->addElement(v);
    geometry->addPrimitiveSet(points);
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, {0.25f, 0.5f, 0.75f, 1.0f});
    geometry->getOrCreateStateSet()->setAttribute(material);
    return geometry;
}

osg::ref_ptr<osgAnimation::Skeleton> makeBones(const std::vector<osgSkin::BoundJoint>& joints) {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    osg::Group* parent = skeleton;
    osg::Vec3d before;
    for (const osgSkin::BoundJoint& joint : joints) {
        const osg::Vec3d centre = osgSkin::toOsg(joint.centre);
        const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(joint.name);
        const osg::ref_ptr<osgAnimation::UpdateBone> update =
            new osgAnimation::UpdateBone(joint.name);
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedTranslateElement("translate", centre - before));
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
        bone->setUpdateCallback(update);
        bone->setMatrix(osg::Matrix::translate(centre - before));
        bone->setMatrixInSkeletonSpace(osg::Matrix::translate(centre));
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(-centre));
        parent->addChild(bone);
        parent = bone;
        before = centre;
    }
    return skeleton;
}

osg::ref_ptr<osgAnimation::Animation> makeBend(const std::string& joint) {
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->setName("bend");
    const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    channel->setName("quaternion");
    channel->setTargetName(joint);
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::QuatKeyframe(0.0, osg::Quat()));
    keys->push_back(osgAnimation::QuatKeyframe(1.0, osg::Quat(1.5, osg::Vec3(1, 0, 0))));
    animation->addChannel(channel);
    animation->computeDuration();
    return animation;
}

osgDB::ReaderWriter* plugin(const std::string& extension) {
    return osgDB::Registry::instance()->getReaderWriterForExtension(extension);
}

osg::ref_ptr<osgDB::Options> optionsFor(const std::string& extension) {
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("precision 17");
    options->setPluginStringData("fileType", extension == "osgt"   ? "Ascii"
                                             : extension == "osgx" ? "XML"
                                                                   : "Binary");
    return options;
}

} // namespace

osg::ref_ptr<osg::Group> makeScene(const Tube& tube) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones(tube.binding.joints);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(makeGeometry(tube), tube.model());
    skin->setTangentAttribute(6);
    skin->setName("tube");
    skin->setEager(true);
    skin->setNodeMask(0x1234);
    skin->setUserValue("answer", 42);
    skin->addDescription("a description");
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy = osg::clone(skin.get());
    copy->setName("copy");
    copy->setEager(false);
    copy->setTangentAttribute(-1);
    copy->setStateSet(new osg::StateSet);
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    update->setUnwrapTwist(false);
    copy->setUpdateCallback(update);
    skin->setPose(somePoses(*skin).front().data(), tube.binding.joints.size());

    auto& end = static_cast<osgAnimation::Bone&>(
        *skeleton->getChild(0)->asGroup()->getChild(0)->asGroup()->getChild(0));
    const osg::ref_ptr<osg::Geometry> rigid = makeGeometry(Tube(2, 3));
    new osgSkin::RigidPart(rigid, end);
    skeleton->addChild(skin);
    skeleton->addChild(copy);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(skeleton);
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    manager->registerAnimation(makeBend("middle"));
    scene->setUpdateCallback(manager);
    return scene;
}

std::vector<osgSkin::DeformableSkin*> skinsOf(osg::Node& root) {
    std::vector<osgSkin::DeformableSkin*> skins;
    if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&root)) skins.push_back(skin);
    if (osg::Group* group = root.asGroup())
        for (unsigned int i = 0; i < group->getNumChildren(); ++i)
            for (osgSkin::DeformableSkin* skin : skinsOf(*group->getChild(i)))
                skins.push_back(skin);
    return skins;
}

std::string save(const osg::Node& scene, const std::string& extension, int version) {
    std::ostringstream out(std::ios::binary);
    const osg::ref_ptr<osgDB::Options> options = optionsFor(extension);
    if (version != 0) options->setPluginStringData("TargetFileVersion", std::to_string(version));
    return plugin(extension)->writeNode(scene, out, options).success() ? out.str() : "";
}

osg::ref_ptr<osg::Node> load(const std::string& file, const std::string& extension,
                             std::string* reason) {
    std::istringstream in(file, std::ios::binary);
    const osg::ref_ptr<osgDB::Options> options = optionsFor(extension);
    osgDB::ReaderWriter::ReadResult result = plugin(extension)->readNode(in, options);
    if (reason) *reason = result.statusMessage();
    return result.takeNode();
}

std::vector<std::vector<glm::dmat4>> somePoses(const osgSkin::DeformableSkin& skin) {
    std::mt19937_64 random(7);
    std::vector<std::vector<glm::dmat4>> poses;
    for (int pose = 0; pose < 5; ++pose) {
        std::vector<glm::dquat> turns;
        for (std::size_t j = 0; j < skin.getModel()->joints().size(); ++j)
            turns.push_back(randomRotation(random));
        poses.push_back(skinningFrom(skin.getModel()->joints(), turns, {0.1, 0.2, 0.3}));
    }
    return poses;
}

std::vector<osg::Vec3> posed(osgSkin::DeformableSkin& skin, const std::vector<glm::dmat4>& pose) {
    skin.setPose(pose.data(), pose.size());
    const osg::Geometry& geometry = *skin.getDeformedGeometry();
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    const auto& normals = static_cast<const osg::Vec3Array&>(*geometry.getNormalArray());
    std::vector<osg::Vec3> all(vertices.begin(), vertices.end());
    all.insert(all.end(), normals.begin(), normals.end());
    for (const osg::Vec4& t : static_cast<const osg::Vec4Array&>(*geometry.getVertexAttribArray(6)))
        all.push_back({t.x(), t.y(), t.z()});
    return all;
}

} // namespace test
