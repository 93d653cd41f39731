// SPDX-License-Identifier: MIT
// Characters in OSG's own scenes: bones, rigs and clips of osgAnimation.
#include "Command.h"
#include "ExpectContains.h"
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osg/ShapeDrawable>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <filesystem>

namespace {

using osgSkin::Character;

osg::ref_ptr<osgAnimation::Bone> makeBone(const std::string& name, const osg::Vec3& offset,
                                          const osg::Vec3& place) {
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
    const osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
    auto& stack = update->getStackedTransforms();
    stack.push_back(new osgAnimation::StackedTranslateElement("translate", offset));
    stack.push_back(new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
    bone->setUpdateCallback(update);
    bone->setMatrix(osg::Matrix::translate(offset));
    bone->setMatrixInSkeletonSpace(osg::Matrix::translate(place));
    bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(-place));
    return bone;
}

osg::ref_ptr<osgAnimation::Animation> makeClip(const std::string& name, double degrees) {
    const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    channel->setName("quaternion");
    channel->setTargetName("upper");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (const double time : {0.0, 1.0})
        keys->push_back(osgAnimation::QuatKeyframe(
            time, osg::Quat(osg::DegreesToRadians(degrees), osg::Vec3(1, 0, 0))));
    osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->setName(name);
    clip->addChannel(channel);
    return clip;
}

/// A file like those of OSG exporters: a skeleton with two top bones, one of them with a hat before
/// its bone; a skin as a sheet of quads over "lower" and "upper", painted so that the weights
/// change at 3 and not at the joint; and a manager with two clips, none of them playing.
std::string sceneFile(const std::string& name) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    const auto lower = makeBone("lower", osg::Vec3(), osg::Vec3());
    const auto upper = makeBone("upper", osg::Vec3(0, 0, 2), osg::Vec3(0, 0, 2));
    const osg::ref_ptr<osg::Geode> hat = new osg::Geode;
    hat->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.2f)));
    lower->addChild(hat);
    lower->addChild(upper);
    skeleton->addChild(lower);
    skeleton->addChild(makeBone("control", osg::Vec3(1, 0, 0), osg::Vec3(1, 0, 0)));

    const osg::ref_ptr<osg::Geometry> sheet = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    const osg::ref_ptr<osg::DrawElementsUInt> quads = new osg::DrawElementsUInt(GL_QUADS);
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (unsigned row = 0; row <= 8; ++row)
        for (unsigned side = 0; side < 2; ++side) {
            const float height = 0.5f * float(row);
            (*map)[height < 3.0f ? "lower" : "upper"].emplace_back(unsigned(places->size()), 1.0f);
            places->push_back(osg::Vec3(side ? 0.5f : -0.5f, 0, height));
        }
    for (unsigned row = 0; row < 8; ++row)
        for (const unsigned corner : {0u, 1u, 3u, 2u}) quads->push_back(2 * row + corner);
    sheet->setVertexArray(places);
    sheet->addPrimitiveSet(quads);
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName("sheet");
    rig->setSourceGeometry(sheet);
    rig->setInfluenceMap(map);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(rig);
    skeleton->addChild(geode);

    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(skeleton);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    manager->registerAnimation(makeClip("rest", 0));
    manager->registerAnimation(makeClip("lean", 40));
    root->setUpdateCallback(manager);
    std::string file = test::makeTestFolder() + "/" + name;
    EXPECT_TRUE(osgDB::writeNodeFile(*root, file));
    return file;
}

/// The rotation of the bone "upper" after some frames, in degrees.
double leanOf(osg::Node& root) {
    for (const double time : {0.0, 0.1, 0.2}) test::updateAt(root, time);
    for (const auto& bone : test::findNodes<osgAnimation::Bone>(root)) {
        if (bone.node->getName() != "upper") continue;
        const osg::Vec3d up =
            osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), bone.node->getMatrix());
        return osg::RadiansToDegrees(std::acos(std::min(1.0, up.z())));
    }
    ADD_FAILURE() << "no bone \"upper\"";
    return 0.0;
}

} // namespace

TEST(OsgScene, PlaysItsFirstClipWithoutWarnings) {
    for (const char* format : {"scene.osgt", "scene.osgb"}) {
        const std::string file = sceneFile(format);
        const test::Notices notices;
        const Character character = osgSkin::loadCharacter(file);
        ASSERT_NE(character.manager, nullptr);
        ASSERT_EQ(character.motions.size(), 2u);
        EXPECT_TRUE(character.manager->isPlaying("rest"));
        EXPECT_NEAR(leanOf(*character.root), 0.0, 1e-3);
        EXPECT_EQ(notices.warnings(), "");
    }
}

TEST(OsgScene, PlaysEachOfSeveralManagers) {
    const std::string file = sceneFile("scene.osgt");
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int copy = 0; copy < 3; ++copy) root->addChild(osgDB::readRefNodeFile(file));
    ASSERT_TRUE(osgDB::writeNodeFile(*root, file));
    const Character character = osgSkin::loadCharacter(file);
    ASSERT_EQ(character.root->getNumChildren(), 3u);
    for (unsigned c = 0; c < 3; ++c) {
        auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(
            character.root->getChild(c)->getUpdateCallback());
        ASSERT_NE(manager, nullptr);
        EXPECT_TRUE(manager->isPlaying("rest")) << c;
    }
}

TEST(OsgScene, AppliesOptions) {
    const std::string file = sceneFile("scene.osgt");
    const Character leaning = osgSkin::loadCharacter(file, test::loadOptions("motion=lean"));
    EXPECT_EQ(leaning.motions.front().name(), "lean");
    EXPECT_NEAR(leanOf(*leaning.root), 40.0, 1e-3);
    const Character still = osgSkin::loadCharacter(file, test::loadOptions("motion=none"));
    EXPECT_EQ(still.manager, nullptr);
    EXPECT_NEAR(leanOf(*still.root), 0.0, 1e-3);
    // A vertex between the joint and the change of the weights.
    const auto region = [](const Character& character) {
        return character.binding.joints.at(character.binding.regions.at(10)).name;
    };
    EXPECT_EQ(region(osgSkin::loadCharacter(file, test::loadOptions("bind=weights"))), "lower");
    EXPECT_NE(region(osgSkin::loadCharacter(file, test::loadOptions("bind=smooth"))), "lower");

    const std::string why = test::whyRefused(file, "motion=run");
    test::expectContains(why, R"("run" is not in the scene, expected one of "rest", "lean")");
    test::expectContains(test::whyRefused(file, "motion=" OSGSKIN_TEST_DATA "/character/move.bvh"),
                         "not carried");
}

TEST(OsgScene, PlaysAfterSaving) {
    const std::string file = sceneFile("scene.osgt");
    const std::string saved = file + ".saved.osgb";
    {
        const Character leaning = osgSkin::loadCharacter(file, test::loadOptions("motion=lean"));
        ASSERT_TRUE(osgDB::writeNodeFile(*leaning.root, saved));
    }
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
    ASSERT_NE(read, nullptr);
    EXPECT_NEAR(leanOf(*read), 40.0, 1e-3);
}

TEST(OsgScene, CanBeBaked) {
    const std::string file = sceneFile("scene.osgt");
    const std::string folder = std::filesystem::path(file).parent_path().string();
    const test::CommandResult result = test::runBake(
        file + " --motion lean --frames 0:0:1 --out frame_%02d.obj --rest rest.obj", folder);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder + "/frame_00.obj"));
    EXPECT_TRUE(std::filesystem::exists(folder + "/rest.obj"));
    const Character character = osgSkin::loadCharacter(file);
    EXPECT_TRUE(character.hasBody());
    EXPECT_EQ(character.body.mesh.positions.size(), 18u);
}
