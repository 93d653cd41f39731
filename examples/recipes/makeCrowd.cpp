// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuCrowd>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osgDB/ReadFile>

#include <stdexcept>

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

/// A thousand members of one character, each in its own phase of one of two clips.
///
/// \param file any character, such as a .skin, a .glb.skin or a saved one
osg::ref_ptr<osg::Node> makeCrowd(const std::string& file) {
    const osg::ref_ptr<osg::Node> loaded = osgDB::readRefNodeFile(file);
    if (!loaded) throw std::runtime_error(file + ": cannot be read");
    const auto character = osgSkin::CrowdCharacter::create(*loaded);
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(character);
    std::vector<osgSkin::CrowdInstance> members(1000);
    for (std::size_t i = 0; i < members.size(); ++i) {
        members[i].position = osg::Vec3d(double(i % 32), double(i / 32), 0.0);
        members[i].clip = character->clip(i % 3 == 0 ? "wave" : "walk");
        members[i].phase = 0.1 * double(i);
    }
    crowd->setInstances(members);
    crowd->addUpdateCallback(new PlayCrowd);
    return crowd;
}
