// SPDX-License-Identifier: MIT
// Props of a character share their files, and the limit on their pictures.
#include "Command.h"
#include "Notices.h"
#include "SkinFiles.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/NodeVisitor>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace {

constexpr int kPropSide = 200;

/// A prop and its picture, which has more pixels than its file's size allows.
/// \return the number of pixels above the allowance
std::size_t saveProp(const std::string& folder, const std::string& name) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kPropSide, kPropSide, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (unsigned i = 0; i < image->getTotalSizeInBytes(); ++i) image->data()[i] = 0;
    osgDB::writeImageFile(*image, folder + "/" + name + ".png");
    std::ofstream(folder + "/" + name + ".mtl") << "newmtl m\nmap_Kd " << name << ".png\n";
    std::ofstream(folder + "/" + name + ".obj")
        << "mtllib " << name
        << ".mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    return std::size_t(kPropSide) * kPropSide -
           16 * std::filesystem::file_size(folder + "/" + name + ".png");
}

std::string saveWithProps(const std::string& folder, const std::vector<std::string>& meshes) {
    std::string props;
    for (const std::string& mesh : meshes)
        props += (props.empty() ? "" : ", ") + ("{\"mesh\": \"" + mesh) +
                 "\", \"motion\": \"m\", \"file\": \"" + test::kTubeFolder + "move.bvh\"}";
    return test::saveSkin(folder + "/props.skin",
                          ", \"shapes\": \"none\", \"motions\": [{\"file\": \"" +
                              test::kTubeFolder + "move.bvh\", \"name\": \"m\"}], \"props\": [" +
                              props + "]");
}

/// The geometries of a character's props.
class PropGeometries : public osg::NodeVisitor {
public:
    PropGeometries() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Geometry& geometry) override {
        const osg::NodePath& path = getNodePath();
        if (path.size() < 2 || path[path.size() - 2]->getName().rfind("prop:", 0) != 0) return;
        ++count;
        all.insert(&geometry);
        if (geometry.getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE) != nullptr)
            ++textured;
    }

    std::size_t count = 0, textured = 0;
    std::set<const osg::Geometry*> all;
};

PropGeometries propsOf(const std::string& file, std::size_t pixels) {
    osgSkin::LoadOptions load;
    load.readOptions = new osgDB::Options("maxPixels=" + std::to_string(pixels));
    PropGeometries props;
    osgSkin::loadCharacter(file, load).root->accept(props);
    return props;
}

} // namespace

TEST(PropPictures, ReadsEachFileOnce) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball");
    const PropGeometries props =
        propsOf(saveWithProps(folder, {"ball.obj", "./ball.obj", "ball.obj"}), pixels);
    EXPECT_EQ(props.count, 3u);
    EXPECT_EQ(props.textured, 3u);
    EXPECT_EQ(props.all.size(), 1u);
}

TEST(PropPictures, LimitsPixelsOfAllPropsTogether) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball") + saveProp(folder, "bat");
    const std::string file = saveWithProps(folder, {"ball.obj", "bat.obj"});
    EXPECT_EQ(propsOf(file, pixels).textured, 2u);
    const test::Notices notices;
    EXPECT_EQ(propsOf(file, pixels - 1).textured, 1u);
    EXPECT_TRUE(notices.say("beside those before it (option maxPixels)")) << notices.text();
}

/// An armature above an object that follows the armature alone.
TEST(PropPictures, WarnsAboutMotionWithSeveralJoints) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball");
    const test::Notices notices;
    EXPECT_EQ(propsOf(saveWithProps(folder, {"ball.obj"}), pixels).count, 1u);
    EXPECT_TRUE(notices.say("move.bvh: has 2 joints, of which a prop follows the first alone"))
        << notices.text();
}
