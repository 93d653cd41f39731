// SPDX-License-Identifier: MIT
//
// The plug-ins in a third-party host, OSG's own osgconv: they are silent, and refuse libraries of
// another build instead of crashing.
//
// `model.glb.skin`: any rigged model, re-skinned, as a viewer reads it.
//
// Props of a character share their files, and the limit on their pictures.
#include "Command.h"
#include "FindNodes.h"
#include "KitCheck.h"
#include "Notices.h"
#include "QuadRig.h"
#include "RiggedModels.h"
#include "TextFile.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/FrameStamp>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/NodeVisitor>
#include <osg/Texture2D>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace {

constexpr char kLibraries[] = "OSG_LIBRARY_PATH='" OSGSKIN_LIBRARIES "' ";

class PlugIn : public testing::Test {
protected:
    void SetUp() override {
        if (OSGSKIN_SANITIZED) GTEST_SKIP() << "osgconv cannot load libraries with sanitizers";
        folder = test::makeTestFolder();
    }
    test::CommandResult convert(const std::string& from, const std::string& to,
                                const std::string& environment = {}) const {
        return test::runCommand(kLibraries + environment + "osgconv '" + from + "' " + to, folder);
    }
    std::string folder;
};

/// Expects that osgconv exited by itself without a result and with a one-line reason.
void expectRefused(const test::CommandResult& result, const std::string& plugIn,
                   const std::string& kit) {
    EXPECT_GE(result.status, 0) << "osgconv was ended by a signal";
    const std::string all = result.out + result.err;
    const std::size_t at = all.find(plugIn + " is left out: ");
    ASSERT_NE(at, std::string::npos) << all;
    EXPECT_EQ(all.find(plugIn + " is left out: ", at + 1), std::string::npos) << all;
    const std::string line = all.substr(at, all.find('\n', at) - at);
    EXPECT_NE(line.find("built with " + kit + " " OSGSKIN_PROJECT_VERSION " ("), std::string::npos)
        << line;
    EXPECT_NE(line.find("0.1.7 (00000000)"), std::string::npos) << line;
}

/// An arm along y, bent by 13 degrees at rest, as a `.skin` file with all files that it names.
void writeArm(const std::string& folder) {
    constexpr int kSides = 16, kRings = 57;
    std::ofstream mesh(folder + "/arm.obj");
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const double angle = 2.0 * 3.141592653589793 * side / kSides;
            mesh << "v " << std::cos(angle) << ' ' << 0.25 * ring << ' ' << -std::sin(angle)
                 << '\n';
        }
    for (int ring = 0; ring + 1 < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const int next = (side + 1) % kSides, low = 1 + ring * kSides, high = low + kSides;
            mesh << "f " << low + side << ' ' << low + next << ' ' << high + next << ' '
                 << high + side << '\n';
        }
    std::ofstream(folder + "/arm.bvh")
        << "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 3 Zrotation Yrotation Xrotation\n"
           " JOINT lower\n {\n  OFFSET 0 7 0.8\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
           "  End Site\n  {\n   OFFSET 0 7 -0.8\n  }\n }\n}\nMOTION\nFrames: 1\n"
           "Frame Time: 0.1\n0 0 0 0 0 0\n";
    std::ofstream(folder + "/arm.skin")
        << R"({ "osgskin": 1, "mesh": "arm.obj", "skeleton": "arm.bvh" })";
}

std::vector<std::filesystem::path> filesIn(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    return files;
}

const char* anotherBuild() {
    return "0.1.7 (00000000)";
}
const char* thisBuild() {
    return "0.2.0 (1a2b3c4d)";
}

} // namespace

TEST_F(PlugIn, IsSilentOnStandardError) {
    for (const char* file :
         {OSGSKIN_DATA "/thrower.skin", OSGSKIN_TEST_DATA "/rig/tube.gltf.skin"}) {
        const test::CommandResult result = convert(file, "saved.osgb");
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
    }
    EXPECT_EQ(convert("saved.osgb", "saved.osgt").err, "") << "the serializers";
}

TEST_F(PlugIn, KeepsElasticShapesInTheUsersCacheFolder) {
    writeArm(folder);
    const std::string cache = "XDG_CACHE_HOME='" + folder + "/cache' ";
    const std::string kept = folder + "/cache/osgSkin";
    ASSERT_EQ(convert("arm.skin", "plain.osgb", cache).status, 0);
    EXPECT_TRUE(filesIn(kept).empty()); // none was requested
    const auto shaped = [&](const std::string& to) {
        const auto result = convert("arm.skin", to + " -O shapes=elastic", cache);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
        return test::fileText(folder + '/' + to);
    };
    const std::string first = shaped("first.osgb");
    EXPECT_GT(first.size(), test::fileText(folder + "/plain.osgb").size());
    ASSERT_EQ(filesIn(kept).size(), 1u);
    const auto written = std::filesystem::last_write_time(filesIn(kept)[0]);
    EXPECT_EQ(shaped("second.osgb"), first);
    EXPECT_EQ(std::filesystem::last_write_time(filesIn(kept)[0]), written);
} // a broken one is made again: see ElasticBind

TEST_F(PlugIn, RefusesLibrariesOfAnotherBuild) {
    expectRefused(
        convert(OSGSKIN_DATA "/thrower.skin", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_BIND "' "),
        "osgdb_skin", "osgSkinBind");
}

TEST_F(PlugIn, SerializersRefuseARuntimeOfAnotherBuild) {
    ASSERT_EQ(convert(OSGSKIN_TEST_DATA "/character/good.skin", "saved.osgt").status, 0);
    expectRefused(convert("saved.osgt", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_RUNTIME "' "),
                  "osgdb_serializers_osgskin", "osgSkin");
}

TEST(KitCheck, OneBuildIsUsed) {
    EXPECT_TRUE(plugin::mayUse("osgdb_any", {{"osgSkin", "0.2.0 (1a2b3c4d)", thisBuild}}));
}

TEST(KitCheck, AnyOtherIsRefusedWithOneLine) {
    struct Case {
        plugin::KitBuild kit;
        const char* found;
    };
    const Case cases[] = {{{"osgSkinRig", "0.2.0 (1a2b3c4d)", anotherBuild}, "0.1.7 (00000000)"},
                          {{"osgSkinRig", "0.2.0 (99999999)", thisBuild}, "0.2.0 (1a2b3c4d)"},
                          {{"osgSkinRig", "0.2.0 (1a2b3c4d)", nullptr}, "an older one"}};
    for (const Case& c : cases) {
        const test::Notices notices;
        const bool used =
            plugin::mayUse("osgdb_any", {{"osgSkin", "0.2.0 (1a2b3c4d)", thisBuild}, c.kit});
        EXPECT_FALSE(used);
        EXPECT_EQ(notices.lines(), 1u);
        for (const char* part : {"osgdb_any", "osgSkinRig", c.kit.compiled, c.found})
            EXPECT_TRUE(notices.say(part)) << notices.text();
    }
}

namespace {

const std::string kTubeSkin = OSGSKIN_TEST_DATA "/rig/tube.gltf.skin";

osg::ref_ptr<osgDB::Options> optionsOf(const std::string& text) {
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options(text);
    options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
    return options;
}

osg::ref_ptr<osg::Node> readCharacter(const std::string& file, const std::string& options = {}) {
    return osgDB::readRefNodeFile(file, optionsOf(options));
}

/// The error message for a file.
std::string complaint(const std::string& file, const std::string& options = {}) {
    osgDB::ReaderWriter::ReadResult result =
        osgDB::Registry::instance()->readNode(file, optionsOf(options));
    EXPECT_FALSE(result.validNode()) << file << " with " << options;
    EXPECT_EQ(result.message().find('\n'), std::string::npos) << result.message();
    return result.message();
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

struct Parts {
    explicit Parts(osg::Node& scene) {
        for (const auto& found : test::findNodes<osg::Node>(scene))
            if (auto* of = dynamic_cast<osgAnimation::BasicAnimationManager*>(
                    found.node->getUpdateCallback()))
                manager = of;
        for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(scene)) {
            skins.push_back(found.node);
            toWorld = found.toWorld;
        }
        rigid = test::findNodes<osgSkin::RigidPart>(scene).size();
        rigs = test::findNodes<osgAnimation::RigGeometry>(scene).size();
    }

    std::vector<osgSkin::DeformableSkin*> skins;
    osg::Matrix toWorld;
    osgAnimation::BasicAnimationManager* manager = nullptr;
    std::size_t rigid = 0, rigs = 0;
};

void update(osg::Node& scene, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
}

/// The world-space box around the posed vertices of all skins.
osg::BoundingBox posedBox(osg::Node& scene) {
    const Parts parts(scene);
    osg::BoundingBox box;
    for (const osgSkin::DeformableSkin* skin : parts.skins)
        for (const osg::Vec3& v :
             static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray()))
            box.expandBy(v * parts.toWorld);
    return box;
}

} // namespace

TEST(PseudoLoader, ReSkinsAndPlaysTheFirstClip) {
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin);
    ASSERT_NE(scene, nullptr);
    const Parts parts(*scene);
    ASSERT_EQ(parts.skins.size(), 1u);
    ASSERT_NE(parts.manager, nullptr);
    EXPECT_EQ(parts.manager->getAnimationList().size(), 2u);
    update(*scene, 0.0);
    const osg::BoundingBox rest = posedBox(*scene);
    // The armature rotates the tube to +Z, but the format has Y up: it points to -Y.
    EXPECT_NEAR(rest.yMin(), -2.0f, 1e-5f);
    EXPECT_NEAR(rest.yMax(), 0.0f, 1e-5f);
    update(*scene, 0.5);
    const osg::BoundingBox waving = posedBox(*scene); // 70 degrees at the arm
    EXPECT_NEAR(waving.xMin(),
                -std::sin(70.0f * 3.14159265f / 180.0f) -
                    0.25f * std::cos(70.0f * 3.14159265f / 180.0f),
                1e-4f);
    const osg::BoundingSphere& bound = scene->getBound();
    EXPECT_TRUE(bound.contains(osg::Vec3(waving.xMin(), waving.yMax(), 0.0f)));
    EXPECT_TRUE(bound.contains(osg::Vec3(0.0f, rest.yMin(), 0.0f)));
}

TEST(PseudoLoader, MotionChoosesTheClip) {
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, "other=1 motion=move more");
    ASSERT_NE(scene, nullptr);
    update(*scene, 0.0);
    const float start = posedBox(*scene).center().x();
    update(*scene, 0.5);
    EXPECT_GT(std::abs(posedBox(*scene).center().x() - start), 0.1f);
    EXPECT_EQ(Parts(*scene).manager->getAnimationList().front()->getName(), "move");

    const osg::ref_ptr<osg::Node> still = readCharacter(kTubeSkin, "motion=none");
    ASSERT_NE(still, nullptr);
    EXPECT_EQ(Parts(*still).manager, nullptr);
    EXPECT_NEAR(posedBox(*still).yMin(), -2.0f, 1e-5f);
}

TEST(PseudoLoader, MotionMayBeAFile) {
    const std::string file = OSGSKIN_TEST_DATA "/character/move.bvh"; // the joints base and arm
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, "motion=\"" + file + "\"");
    ASSERT_NE(scene, nullptr);
    ASSERT_NE(Parts(*scene).manager, nullptr);
    EXPECT_EQ(Parts(*scene).manager->getAnimationList().front()->getName(), "move");
    update(*scene, 0.0);
    EXPECT_TRUE(posedBox(*scene).valid());
}

TEST(PseudoLoader, OptionsChangeTheBinding) {
    const auto positionsAt = [](const std::string& options) {
        const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, options);
        EXPECT_NE(scene, nullptr) << options;
        update(*scene, 0.5);
        const auto& vertices = static_cast<const osg::Vec3Array&>(
            *Parts(*scene).skins.at(0)->getDeformedGeometry()->getVertexArray());
        std::vector<osg::Vec3> sorted(vertices.begin(), vertices.end());
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    };
    EXPECT_EQ(positionsAt(""), positionsAt("bind=weights")) << "the file is well painted";
    EXPECT_NE(positionsAt(""), positionsAt("bind=smooth"));
    EXPECT_NE(positionsAt("bind=paper"), positionsAt("bind=smooth"));
    EXPECT_EQ(Parts(*readCharacter(kTubeSkin, "rigid=none")).rigid, 0u);
    EXPECT_EQ(Parts(*readCharacter(kTubeSkin, "rigid=arm")).rigid, 1u);
    EXPECT_EQ(Parts(*readCharacter(kTubeSkin, "rigid=merged")).rigid, 0u);
}

TEST(PseudoLoader, ShowRegionsColoursThem) {
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, "show=regions rigid=none");
    ASSERT_NE(scene, nullptr);
    const auto* colours = dynamic_cast<const osg::Vec4Array*>(
        Parts(*scene).skins.at(0)->getRestGeometry()->getColorArray());
    ASSERT_NE(colours, nullptr);
    EXPECT_EQ(std::set<osg::Vec4>(colours->begin(), colours->end()).size(), 2u);
    const osg::ref_ptr<osg::Node> character =
        readCharacter(OSGSKIN_TEST_DATA "/character/good.skin", "show=regions motion=none");
    ASSERT_NE(character, nullptr);
    EXPECT_NE(Parts(*character).skins.at(0)->getRestGeometry()->getColorArray(), nullptr);
    EXPECT_EQ(character->getUpdateCallback(), nullptr);
}

TEST(PseudoLoader, ConvertsRigsThatOsgReads) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    const osg::ref_ptr<osgAnimation::Bone> low = new osgAnimation::Bone("low");
    const osg::ref_ptr<osgAnimation::Bone> high = new osgAnimation::Bone("high");
    high->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(0, 0, -1));
    low->addChild(high);
    skeleton->addChild(low);
    osgAnimation::VertexInfluenceMap map;
    map["low"].assign({{1, 1.0f}, {2, 1.0f}});
    map["high"].assign({{0, 1.0f}, {3, 1.0f}});
    skeleton->addChild(test::makeQuadRig(map));
    const std::string file = testing::TempDir() + "osg_rig.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*skeleton, file));
    const osg::ref_ptr<osg::Node> scene = readCharacter(file + ".skin");
    ASSERT_NE(scene, nullptr);
    EXPECT_EQ(Parts(*scene).skins.size(), 1u);
    EXPECT_EQ(Parts(*scene).rigs, 0u);
}

TEST(PseudoLoader, LoadsEveryRiggedTestModel) {
    if (!std::filesystem::exists(test::kModels)) GTEST_SKIP() << test::kModels << " is missing";
    for (const test::Rigged& rigged : test::kRigged) {
        SCOPED_TRACE(rigged.file);
        const osg::ref_ptr<osg::Node> scene =
            readCharacter(std::string(test::kModels) + rigged.file + ".skin");
        ASSERT_NE(scene, nullptr);
        Parts parts(*scene);
        EXPECT_GT(parts.skins.size() + parts.rigid, 0u);
        EXPECT_EQ(parts.manager != nullptr, rigged.clips > 0);
        update(*scene, 0.25);
        EXPECT_EQ(posedBox(*scene).valid(), !parts.skins.empty());
    }
}

TEST(PseudoLoader, RefusesWithAReason) {
    EXPECT_SAYS(complaint(OSGSKIN_TEST_DATA "/rig/unskinned.gltf.skin"), "no mesh with bones");
    EXPECT_SAYS(complaint(OSGSKIN_TEST_DATA "/bvh/two_joints.bvh.skin"), "no mesh with bones");
    EXPECT_SAYS(complaint(OSGSKIN_DATA "/thrower.obj.skin"), "no mesh with bones");
    EXPECT_SAYS(complaint(OSGSKIN_TEST_DATA "/mesh/broken.osgt.skin"), "broken.osgt");
    EXPECT_SAYS(complaint(kTubeSkin, "motion=dance"), "expected one of \"wave\", \"move\"");
    EXPECT_SAYS(complaint(kTubeSkin, "bind=tight"), "bind=tight: expected smooth");
    EXPECT_SAYS(complaint(kTubeSkin, "show=bones"), "expected skin or regions");
    EXPECT_SAYS(complaint(kTubeSkin, "rigid="), "names of joints");
    EXPECT_SAYS(complaint(kTubeSkin, "rigid=nobody"), "nobody");
    EXPECT_SAYS(complaint(OSGSKIN_TEST_DATA "/character/good.skin", "motion=dance"),
                "neither one of its motions nor a file");
}

TEST(PseudoLoader, ListsItsOptions) {
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("skin");
    ASSERT_NE(reader, nullptr);
    std::string all;
    for (const auto& [option, meaning] : reader->supportedOptions()) all += option + " ";
    for (const char* word : {"bind=", "motion=", "rigid=", "show="}) EXPECT_SAYS(all, word);
}

namespace {

const std::string kFigure = OSGSKIN_TEST_DATA "/character/";
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
                 "\", \"motion\": \"m\", \"file\": \"" + kFigure + "move.bvh\"}";
    std::string path = folder + "/props.skin";
    std::ofstream(path) << "{\"osgskin\": 1, \"mesh\": \"" << kFigure
                        << "body.obj\", \"skeleton\": \"" << kFigure
                        << "rig.bvh\", \"shapes\": \"none\", \"motions\": [{\"file\": \"" << kFigure
                        << "move.bvh\", \"name\": \"m\"}], \"props\": [" << props << "]}";
    return path;
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

TEST(PropPictures, OfOneFileAreReadOnce) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball");
    const PropGeometries props =
        propsOf(saveWithProps(folder, {"ball.obj", "./ball.obj", "ball.obj"}), pixels);
    EXPECT_EQ(props.count, 3u);
    EXPECT_EQ(props.textured, 3u);
    EXPECT_EQ(props.all.size(), 1u);
}

TEST(PropPictures, OfACharacterCountTogether) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball") + saveProp(folder, "bat");
    const std::string file = saveWithProps(folder, {"ball.obj", "bat.obj"});
    EXPECT_EQ(propsOf(file, pixels).textured, 2u);
    const test::Notices notices;
    EXPECT_EQ(propsOf(file, pixels - 1).textured, 1u);
    EXPECT_TRUE(notices.say("beside those before it (option maxPixels)")) << notices.text();
}

/// An armature above an object that follows the armature alone.
TEST(PropPictures, ComeWithAWordWhereTheirMotionHasMoreJoints) {
    const std::string folder = test::makeTestFolder();
    const std::size_t pixels = saveProp(folder, "ball");
    const test::Notices notices;
    EXPECT_EQ(propsOf(saveWithProps(folder, {"ball.obj"}), pixels).count, 1u);
    EXPECT_TRUE(notices.say("move.bvh: has 2 joints, of which a prop follows the first alone"))
        << notices.text();
}
