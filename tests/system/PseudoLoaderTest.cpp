// SPDX-License-Identifier: MIT
// `model.glb.skin`: any rigged model, re-skinned, as a viewer reads it.
#include "ExpectContains.h"
#include "FindNodes.h"
#include "QuadRig.h"
#include "RiggedModels.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

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

TEST(PseudoLoader, ConvertsModelAndPlaysFirstClip) {
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin);
    ASSERT_NE(scene, nullptr);
    const Parts parts(*scene);
    ASSERT_EQ(parts.skins.size(), 1u);
    ASSERT_NE(parts.manager, nullptr);
    EXPECT_EQ(parts.manager->getAnimationList().size(), 2u);
    test::updateAt(*scene, 0.0);
    const osg::BoundingBox rest = posedBox(*scene);
    // The armature rotates the tube to +Z, but the format has Y up: it points to -Y.
    EXPECT_NEAR(rest.yMin(), -2.0f, 1e-5f);
    EXPECT_NEAR(rest.yMax(), 0.0f, 1e-5f);
    test::updateAt(*scene, 0.5);
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
    test::updateAt(*scene, 0.0);
    const float start = posedBox(*scene).center().x();
    test::updateAt(*scene, 0.5);
    EXPECT_GT(std::abs(posedBox(*scene).center().x() - start), 0.1f);
    EXPECT_EQ(Parts(*scene).manager->getAnimationList().front()->getName(), "move");

    const osg::ref_ptr<osg::Node> still = readCharacter(kTubeSkin, "motion=none");
    ASSERT_NE(still, nullptr);
    EXPECT_EQ(Parts(*still).manager, nullptr);
    EXPECT_NEAR(posedBox(*still).yMin(), -2.0f, 1e-5f);
}

TEST(PseudoLoader, MotionReadsAFile) {
    const std::string file = OSGSKIN_TEST_DATA "/character/move.bvh"; // the joints base and arm
    const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, "motion=\"" + file + "\"");
    ASSERT_NE(scene, nullptr);
    ASSERT_NE(Parts(*scene).manager, nullptr);
    EXPECT_EQ(Parts(*scene).manager->getAnimationList().front()->getName(), "move");
    test::updateAt(*scene, 0.0);
    EXPECT_TRUE(posedBox(*scene).valid());
}

TEST(PseudoLoader, OptionsChangeTheBinding) {
    const auto positionsAt = [](const std::string& options) {
        const osg::ref_ptr<osg::Node> scene = readCharacter(kTubeSkin, options);
        EXPECT_NE(scene, nullptr) << options;
        test::updateAt(*scene, 0.5);
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

TEST(PseudoLoader, ShowColoursRegions) {
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

TEST(PseudoLoader, ConvertsOsgScene) {
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
        test::updateAt(*scene, 0.25);
        EXPECT_EQ(posedBox(*scene).valid(), !parts.skins.empty());
    }
}

TEST(PseudoLoader, ExplainsErrors) {
    test::expectContains(complaint(OSGSKIN_TEST_DATA "/rig/unskinned.gltf.skin"),
                         "no mesh with bones");
    test::expectContains(complaint(OSGSKIN_TEST_DATA "/bvh/two_joints.bvh.skin"),
                         "no mesh with bones");
    test::expectContains(complaint(OSGSKIN_DATA "/thrower.obj.skin"), "no mesh with bones");
    test::expectContains(complaint(OSGSKIN_TEST_DATA "/mesh/broken.osgt.skin"), "broken.osgt");
    test::expectContains(complaint(kTubeSkin, "motion=dance"),
                         "expected one of \"wave\", \"move\"");
    test::expectContains(complaint(kTubeSkin, "bind=tight"), "bind=tight: expected smooth");
    test::expectContains(complaint(kTubeSkin, "show=bones"), "expected skin or regions");
    test::expectContains(complaint(kTubeSkin, "rigid="), "names of joints");
    test::expectContains(complaint(kTubeSkin, "rigid=nobody"), "nobody");
    test::expectContains(complaint(OSGSKIN_TEST_DATA "/character/good.skin", "motion=dance"),
                         "neither one of its motions nor a file");
}

TEST(PseudoLoader, ListsItsOptions) {
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("skin");
    ASSERT_NE(reader, nullptr);
    std::string all;
    for (const auto& [option, meaning] : reader->supportedOptions()) all += option + " ";
    for (const char* word : {"bind=", "motion=", "rigid=", "show="})
        test::expectContains(all, word);
}
