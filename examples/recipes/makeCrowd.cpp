// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuCrowd>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

namespace {

/// Plays the clips of a crowd.
struct PlayCrowd : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        auto& crowd = static_cast<osgSkin::GpuCrowd&>(*node);
        crowd.setTime(nv->getFrameStamp()->getSimulationTime());
        traverse(node, nv);
    }
};

} // namespace

/// A thousand members of one character, loaded or saved, each in its own phase of one of its clips.
osg::ref_ptr<osg::Node> makeCrowd(osg::Node& of) {
    const auto character = osgSkin::CrowdCharacter::create(of);
    const osg::BoundingBox& box = character->bounds();
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(character);
    std::vector<osgSkin::CrowdInstance> members(1000);
    for (std::size_t i = 0; i < members.size(); ++i) {
        members[i].position.x() = double(i % 32) * (box.xMax() - box.xMin());
        members[i].position.y() = double(i / 32) * (box.yMax() - box.yMin());
        members[i].clip = static_cast<unsigned int>(i % 3 == 0 ? character->clipCount() - 1 : 0);
        members[i].phase = 0.1 * double(i);
    }
    crowd->setInstances(members);
    crowd->addUpdateCallback(new PlayCrowd);
    return crowd;
}
