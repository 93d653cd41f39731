// SPDX-License-Identifier: MIT
// loadCharacter() as an application calls it: inputs, results, errors.
#include "Command.h"
#include "DrawnSkin.h"
#include "ExpectContains.h"
#include "FindNodes.h"
#include "QuadRig.h"
#include "SkinFiles.h"
#include "TextFile.h"
#include "UpdateAt.h"
#include "WhyRefused.h"

#include <osgSkin/DeformJob>
#include <osgSkin/Error>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;
using osgSkin::LoadOptions;
using osgSkin::UpdatePlayedSkeleton;

const std::string kGood = OSGSKIN_TEST_DATA "/character/good.skin";
const std::string kTube = OSGSKIN_TEST_DATA "/rig/tube.gltf";
const std::string kMove = OSGSKIN_TEST_DATA "/character/move.bvh";

std::vector<std::string> motionsOf(const Character& character) {
    std::vector<std::string> names;
    for (const osgSkin::CharacterMotion& motion : character.motions) names.push_back(motion.name());
    return names;
}

/// Writes an osgAnimation scene with one rig to a file.
std::string rigOfOsg() {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("bone");
    skeleton->addChild(bone);
    osgAnimation::VertexInfluenceMap map;
    map["bone"].assign({{0, 1.0f}, {1, 1.0f}, {2, 1.0f}, {3, 1.0f}});
    skeleton->addChild(test::makeQuadRig(map));
    std::string file = testing::TempDir() + "load_character_rig.osgt";
    EXPECT_TRUE(osgDB::writeNodeFile(*skeleton, file));
    return file;
}

osg::Matrixd skeletonToWorld(osg::Node& scene) {
    return test::findNodes<osgAnimation::Skeleton>(scene).at(0).toWorld;
}

/// Two updates: the first one runs the bones' callbacks.
void playTo(Character& character, double time) {
    test::updateAt(*character.root, 0.0);
    test::updateAt(*character.root, time);
}

/// Matrices of the nodes of this name, relative to their parents.
std::vector<osg::Matrix> placesOf(osg::Node& node, const std::string& name) {
    std::vector<osg::Matrix> places;
    for (const auto& found : test::findNodes<osg::MatrixTransform>(node))
        if (found.node->getName() == name) places.push_back(found.node->getMatrix());
    return places;
}

} // namespace

TEST(LoadCharacter, LoadsSkinFile) {
    const Character character = loadCharacter(kGood);
    EXPECT_EQ(character.file, kGood);
    EXPECT_EQ(character.meshFile, OSGSKIN_TEST_DATA "/character/body.obj");
    EXPECT_TRUE(character.hasBody());
    EXPECT_EQ(character.binding.vertexCount(), character.body.mesh.positions.size());
    EXPECT_EQ(character.bindReport.vertices, character.body.mesh.positions.size());
    EXPECT_EQ(character.rest.joints.size(), character.binding.joints.size());
    EXPECT_EQ(motionsOf(character), (std::vector<std::string>{"move", "later"}));
    for (const osgSkin::CharacterMotion& motion : character.motions) {
        EXPECT_TRUE(motion.isSampled());
        EXPECT_NEAR(motion.duration(), motion.clip.frameTime * double(motion.clip.frames), 1e-9);
        EXPECT_FALSE(motion.report.entries.empty());
    }
    EXPECT_FALSE(character.isZUp());
    EXPECT_LT((osg::Vec3d(0, 1, 0) * character.toWorld - osg::Vec3d(0, 0, 1)).length(), 1e-12);
    EXPECT_EQ(character.root->getUpdateCallback(), character.manager);
    EXPECT_TRUE(character.root->getBound().valid());
}

/// Each prop follows its own motion, from that motion's start, in any order.
TEST(LoadCharacter, PropsFollowTheirOwnMotions) {
    const auto prop = [&](const char* motion) {
        return "{\"mesh\": \"" + test::kTubeFolder + "body.obj\", \"motion\": \"" + motion +
               "\", \"file\": \"" + kMove + "\"}";
    };
    const std::string file = test::saveSkin(
        testing::TempDir() + "load_character_props.skin",
        ", \"motions\": [{\"file\": \"" + kMove + "\", \"name\": \"move\"}, {\"file\": \"" + kMove +
            "\", \"name\": \"later\", \"skipFrames\": 2}], \"props\": [" + prop("later") + ", " +
            prop("move") + ", " + prop("later") + "]");
    const Character character = loadCharacter(file);
    const std::pair<const char*, double> places[] = {
        {"prop:later:0", 0.2}, {"prop:move:1", 0.0}, {"prop:later:2", 0.2}};
    for (const auto& [name, x] : places) {
        const std::vector<osg::Matrix> found = placesOf(*character.root, name);
        ASSERT_EQ(found.size(), 1u) << name;
        EXPECT_NEAR(found[0].getTrans().x(), x, 1e-6) << name;
    }
}

/// A prop that does not move has one sample; a prop with another frame rate begins between two of
/// them.
TEST(LoadCharacter, ResamplesPropsWithOtherFrameRates) {
    const std::string folder = test::makeTestFolder();
    const auto place = [&](const char* name, const char* samples) {
        std::ofstream(folder + "/" + name)
            << "HIERARCHY\nROOT thing\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
               "Zrotation Yrotation Xrotation\n"
               "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\n"
            << samples;
        return "{\"mesh\": \"" + test::kTubeFolder +
               "body.obj\", \"motion\": \"later\", \"file\": \"" + name + "\"}";
    };
    const std::string still = place("still.bvh", "Frames: 1\nFrame Time: 0.1\n0.7 0 0 0 0 0\n");
    const std::string slow =
        place("slow.bvh", "Frames: 4\nFrame Time: 0.15\n0 0 0 0 0 0\n0.15 0 0 30 0 0\n"
                          "0.3 0 0 60 0 0\n0.45 0 0 90 0 0\n");
    const Character character = loadCharacter(
        test::saveSkin(folder + "/props.skin", ", \"motions\": [{\"file\": \"" + kMove +
                                                   "\", \"name\": \"later\", \"skipFrames\": 2}], "
                                                   "\"props\": [" +
                                                   still + ", " + slow + "]"));
    const osg::Matrix stays = placesOf(*character.root, "prop:later:0").at(0);
    EXPECT_NEAR(stays.getTrans().x(), 0.7, 1e-6);
    const osg::Matrix goes = placesOf(*character.root, "prop:later:1").at(0); // 0.2 s after its own
    EXPECT_NEAR(goes.getTrans().x(), 0.2, 1e-6);
    const osg::Vec3d x = osg::Matrix::transform3x3(osg::Vec3d(1, 0, 0), goes);
    EXPECT_NEAR(std::atan2(x.y(), x.x()), osg::DegreesToRadians(40.0), 1e-5);
}

/// JSON does not distinguish 1 from 1.0.
TEST(LoadCharacter, ReadsWholeNumbersWithDecimalPoint) {
    const auto framesOf = [](const std::string& version, const std::string& skipped) {
        const std::string file = test::saveText(
            "whole.skin", "{\"osgskin\": " + version + ", \"mesh\": \"" + test::kTubeFolder +
                              "body.obj\", \"skeleton\": \"" + test::kTubeFolder +
                              "rig.bvh\", \"motions\": [{\"file\": \"" + kMove +
                              "\", \"skipFrames\": " + skipped + "}]}");
        return loadCharacter(file).motions.at(0).clip.frames;
    };
    const std::size_t all = framesOf("1", "0");
    EXPECT_EQ(framesOf("1.0", "2.0"), all - 2);
    EXPECT_EQ(framesOf("1e0", "20e-1"), all - 2);
    EXPECT_EQ(framesOf("1", "-0.0"), all);
    EXPECT_EQ(framesOf("1", "-0"), all);
    for (const char* none : {"1.5", "-1.0", "1e300", "-1e-300"})
        EXPECT_THROW(framesOf("1", none), osgSkin::Error) << none;
}

TEST(LoadCharacter, LoadsRiggedModelWithAndWithoutSkinExtension) {
    for (const std::string& file : {kTube, kTube + ".skin"}) {
        const Character character = loadCharacter(file);
        EXPECT_EQ(character.file, kTube);
        EXPECT_TRUE(character.hasBody());
        EXPECT_EQ(character.skin.skins.size(), 1u);
        EXPECT_EQ(motionsOf(character), (std::vector<std::string>{"wave", "move"}));
        EXPECT_FALSE(character.motions.front().isSampled());
        EXPECT_NEAR(character.motions.front().duration(), 1.0, 1e-6);
    }
}

TEST(LoadCharacter, ConvertsOsgScene) {
    const std::string file = rigOfOsg();
    const Character character = loadCharacter(file);
    EXPECT_TRUE(character.hasBody());
    EXPECT_EQ(character.body.mesh.positions.size(), 4u);
    EXPECT_EQ(character.file, file);
    ASSERT_EQ(character.skin.skins.size(), 1u);
    EXPECT_EQ(character.skin.skins.front().drawable->getModel()->vertexCount(), 4u);
    EXPECT_EQ(character.manager, nullptr);
}

TEST(LoadCharacter, StartsInTheFirstPoseOfTheFirstMotion) {
    Character character = loadCharacter(kGood);
    const std::vector<osg::Vec3d> loaded = test::drawnVertices(character);
    character.pose(character.motions.front(), 2);
    EXPECT_NE(test::drawnVertices(character), loaded);
    character.pose(character.motions.front(), 0);
    EXPECT_EQ(test::drawnVertices(character), loaded);
}

TEST(LoadCharacter, PoseAtMatchesSamples) {
    Character character = loadCharacter(kGood);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    for (std::size_t frame = 0; frame < motion.clip.frames; ++frame) {
        character.pose(motion, frame);
        const std::vector<osg::Vec3d> exact = test::drawnVertices(character);
        character.poseAt(motion, motion.clip.frameTime * double(frame));
        const std::vector<osg::Vec3d> played = test::drawnVertices(character);
        ASSERT_EQ(played.size(), exact.size());
        for (std::size_t i = 0; i < exact.size(); ++i)
            EXPECT_LT((played[i] - exact[i]).length(), 1e-5) << "frame " << frame;
    }
}

TEST(LoadCharacter, PosesAnimationOfRiggedModel) {
    Character character = loadCharacter(kTube);
    const osgSkin::CharacterMotion& wave = character.motions.front();
    character.poseAt(wave, 0.0);
    const std::vector<osg::Vec3d> start = test::drawnVertices(character);
    character.poseAt(wave, 0.5);
    EXPECT_NE(test::drawnVertices(character), start);
    character.poseAt(wave, 0.0);
    EXPECT_EQ(test::drawnVertices(character), start);
    EXPECT_THROW(character.pose(wave, 0), osgSkin::Error) << "it has no samples";
}

TEST(LoadCharacter, RejectsFramesBeyondTheMotion) {
    Character character = loadCharacter(kGood);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    EXPECT_NO_THROW(character.pose(motion, motion.clip.frames - 1));
    try {
        character.pose(motion, motion.clip.frames);
        ADD_FAILURE() << "it is posed";
    } catch (const osgSkin::Error& error) {
        const std::string said = error.what();
        test::expectContains(said, kGood);
        test::expectContains(said, "samples, found frame");
    }
}

TEST(LoadCharacter, UsesGpuOnlyIfAskedTo) {
    for (const bool gpu : {false, true}) {
        LoadOptions options;
        options.gpu = gpu;
        const Character character = loadCharacter(kGood, options);
        ASSERT_FALSE(character.skin.skins.empty());
        for (const auto& skin : character.skin.skins)
            EXPECT_EQ(skin.drawable->getDrawBackend() != nullptr, gpu);
    }
}

TEST(LoadCharacter, InitialBoundContainsTheWholeMotion) {
    Character character = loadCharacter(kGood);
    const osg::BoundingSphere told = character.root->getInitialBound();
    ASSERT_TRUE(told.valid());
    const osgSkin::CharacterMotion& motion = character.motions.at(0);
    osg::BoundingBoxd box;
    for (std::size_t frame = 0; frame < motion.clip.frames; ++frame) {
        character.pose(motion, frame);
        test::forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& p) {
            ASSERT_LE((p * character.toWorld - told.center()).length(), told.radius()) << frame;
            box.expandBy(p * character.toWorld);
        });
    }
    EXPECT_LT(told.radius(), 1.25 * box.radius()); // but not by much
}

TEST(LoadCharacter, RequestedMotionFileComesFirst) {
    for (const std::string& file : {kGood, kTube}) {
        LoadOptions options;
        options.motion = kMove;
        const Character character = loadCharacter(file, options);
        ASSERT_FALSE(character.motions.empty());
        EXPECT_TRUE(character.motions.front().isSampled()) << file;
        // Its own name if the file already has a motion of that name.
        EXPECT_EQ(character.motions.front().name(), file == kGood ? kMove : "move");
    }
}

TEST(LoadCharacter, AtRestHasNoMotions) {
    for (const std::string& file : {kGood, kTube}) {
        LoadOptions options;
        options.atRest = true;
        const Character character = loadCharacter(file, options);
        EXPECT_TRUE(character.motions.empty());
        EXPECT_EQ(character.manager, nullptr);
        EXPECT_EQ(character.root->getUpdateCallback(), nullptr);
    }
}

/// Kernels store vertices in their groups' own frames: rounding would show.
TEST(LoadCharacter, IdentityPoseIsBitwiseTheRestPose) {
    const Character character = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    ASSERT_FALSE(character.skin.skins.empty());
    for (const auto& skin : character.skin.skins) {
        const osgSkin::SkinModel& model = *skin.drawable->getModel();
        osgSkin::Pose pose(model.joints());
        const std::vector<glm::dmat4> identity(pose.size(), glm::dmat4(1.0));
        ASSERT_TRUE(pose.set(identity.data(), identity.size()));
        std::vector<glm::vec3> positions(model.vertexCount()), normals(positions.size());
        osgSkin::DeformJob job;
        job.model = &model;
        job.pose = &pose;
        job.positions = positions.data();
        job.normals = normals.data();
        job.positionCount = job.normalCount = positions.size();
        const auto expectRest = [&] {
            EXPECT_EQ(std::memcmp(positions.data(), model.positions().data(),
                                  positions.size() * sizeof(glm::vec3)),
                      0);
            EXPECT_EQ(std::memcmp(normals.data(), model.normals().data(),
                                  normals.size() * sizeof(glm::vec3)),
                      0);
            positions.assign(positions.size(), glm::vec3(9.0f));
            normals = positions;
        };
        ASSERT_TRUE(job.run());
        expectRest();
        for (std::size_t part = job.partCount(); part-- > 0;) ASSERT_TRUE(job.runPart(part));
        expectRest();
        ASSERT_TRUE(job.runReference());
        expectRest();
    }
}

TEST(LoadCharacter, SkinFilesAndRiggedModelsGiveTheSameErrors) {
    LoadOptions dance, nobody;
    dance.motion = "dance";
    nobody.rigid = {"nobody"};
    for (const std::string& file : {kGood, kTube}) {
        const std::string motion = test::whyRefused(file, dance);
        EXPECT_EQ(motion.rfind(file + ": motion \"dance\" is neither", 0), 0u) << motion;
        test::expectContains(motion, "expected one of \"");
        const std::string rigid = test::whyRefused(file, nobody);
        EXPECT_EQ(rigid.rfind(file + ": ", 0), 0u) << rigid;
        test::expectContains(rigid, "nobody");
    }
}

TEST(LoadCharacter, RejectsMissingFiles) {
    osg::setNotifyLevel(osg::FATAL);
    for (const char* file : {"nowhere.skin", "nowhere.glb", "nowhere.glb.skin", "nowhere.osgt"}) {
        const std::string why = test::whyRefused(file);
        EXPECT_EQ(why.rfind("nowhere.", 0), 0u) << file << ": " << why;
    }
    osg::setNotifyLevel(osg::NOTICE);
}

/// As a program sees them that knows osgDB and osgAnimation alone.
TEST(LoadCharacter, BonesMoveWithTheClip) {
    const std::string file = OSGSKIN_DATA "/thrower.skin",
                      saved = test::makeTestFolder() + "/a.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*osgDB::readRefNodeFile(file), saved));
    Character posed = loadCharacter(file);
    for (const std::string& name : {file, file, saved}) { // two of one file, and a saved one
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(name);
        ASSERT_NE(scene, nullptr) << name;
        test::updateAt(*scene, 0.0);
        for (const double time : {0.5, 1.0}) {
            test::updateAt(*scene, time);
            posed.poseAt(posed.motions.front(), time);
            for (const auto& [node, toWorld] : test::findNodes<osgAnimation::Bone>(*scene)) {
                const osg::Vec3d expected =
                    posed.bone(node->getName())->getMatrixInSkeletonSpace().getTrans();
                EXPECT_LT((node->getMatrixInSkeletonSpace().getTrans() - expected).length(), 1e-5)
                    << node->getName() << " " << time;
                EXPECT_LT((toWorld.getTrans() - expected * skeletonToWorld(*scene)).length(), 1e-5)
                    << node->getName() << " " << time;
            }
        }
    }
}

TEST(LoadCharacter, PosesDoNotDependOnPlaying) {
    Character character = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    Character still = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    playTo(character, 0.5);
    const auto expectSame = [&] {
        const auto a = test::drawnVertices(character), b = test::drawnVertices(still);
        for (std::size_t i = 0; i < a.size(); ++i) ASSERT_LT((a[i] - b[i]).length(), 2e-6) << i;
    };
    for (const double seconds : {0.0, 0.4, 0.5}) {
        character.poseAt(character.motions.front(), seconds);
        still.poseAt(still.motions.front(), seconds);
        expectSame();
        playTo(character, 0.3);
        ASSERT_TRUE(UpdatePlayedSkeleton::of(*character.skeleton)->skipsBones());
    }
    character.pose(character.motions.front(), 50);
    still.pose(still.motions.front(), 50);
    expectSame();
}
