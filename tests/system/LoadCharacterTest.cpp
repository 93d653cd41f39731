// SPDX-License-Identifier: MIT
//
// loadCharacter() as an application calls it: inputs, results, errors.
//
// An application can receive progress of a load; only our programs print it.
#include "Command.h"
#include "DrawnSkin.h"
#include "FindNodes.h"
#include "ProgressLine.h"
#include "QuadRig.h"
#include "UpdateAt.h"
#include "WhyRefused.h"

#include <osgSkin/DeformJob>
#include <osgSkin/Error>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/ProgressOption>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
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

/// The positions of all drawn copies in rest space.
std::vector<osg::Vec3d> drawn(const Character& character) {
    std::vector<osg::Vec3d> result;
    test::forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& p) { result.push_back(p); });
    return result;
}

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

/// Matrices of the nodes of this name, relative to their parents.
std::vector<osg::Matrix> placesOf(osg::Node& node, const std::string& name) {
    std::vector<osg::Matrix> places;
    for (const auto& found : test::findNodes<osg::MatrixTransform>(node))
        if (found.node->getName() == name) places.push_back(found.node->getMatrix());
    return places;
}

} // namespace

TEST(LoadCharacter, MakesASkinFile) {
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
TEST(LoadCharacter, PropsGoWithTheirMotions) {
    const std::string file = testing::TempDir() + "load_character_props.skin";
    const std::string data = OSGSKIN_TEST_DATA "/character/";
    const auto prop = [&](const char* motion) {
        return "{\"mesh\": \"" + data + "body.obj\", \"motion\": \"" + motion + "\", \"file\": \"" +
               kMove + "\"}";
    };
    std::ofstream(file) << "{\"osgskin\": 1, \"mesh\": \"" << data << "body.obj\", \"skeleton\": \""
                        << data << "rig.bvh\", \"motions\": [{\"file\": \"" << kMove
                        << "\", \"name\": \"move\"}, {\"file\": \"" << kMove
                        << "\", \"name\": \"later\", \"skipFrames\": 2}], \"props\": ["
                        << prop("later") << ", " << prop("move") << ", " << prop("later") << "]}";
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
TEST(LoadCharacter, PropsOfOtherRatesGoOnBesideTheirMotion) {
    const std::string folder = test::makeTestFolder(), file = folder + "/props.skin";
    const std::string data = OSGSKIN_TEST_DATA "/character/";
    const auto place = [&](const char* name, const char* samples) {
        std::ofstream(folder + "/" + name)
            << "HIERARCHY\nROOT thing\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
               "Zrotation Yrotation Xrotation\n"
               "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\n"
            << samples;
        return "{\"mesh\": \"" + data + "body.obj\", \"motion\": \"later\", \"file\": \"" + name +
               "\"}";
    };
    const std::string still = place("still.bvh", "Frames: 1\nFrame Time: 0.1\n0.7 0 0 0 0 0\n");
    const std::string slow =
        place("slow.bvh", "Frames: 4\nFrame Time: 0.15\n0 0 0 0 0 0\n0.15 0 0 30 0 0\n"
                          "0.3 0 0 60 0 0\n0.45 0 0 90 0 0\n");
    std::ofstream(file) << "{\"osgskin\": 1, \"mesh\": \"" << data << "body.obj\", \"skeleton\": \""
                        << data << "rig.bvh\", \"motions\": [{\"file\": \"" << kMove
                        << "\", \"name\": \"later\", \"skipFrames\": 2}], \"props\": [" << still
                        << ", " << slow << "]}";
    const Character character = loadCharacter(file);
    const osg::Matrix stays = placesOf(*character.root, "prop:later:0").at(0);
    EXPECT_NEAR(stays.getTrans().x(), 0.7, 1e-6);
    const osg::Matrix goes = placesOf(*character.root, "prop:later:1").at(0); // 0.2 s after its own
    EXPECT_NEAR(goes.getTrans().x(), 0.2, 1e-6);
    const osg::Vec3d x = osg::Matrix::transform3x3(osg::Vec3d(1, 0, 0), goes);
    EXPECT_NEAR(std::atan2(x.y(), x.x()), osg::DegreesToRadians(40.0), 1e-5);
}

/// JSON does not distinguish 1 from 1.0.
TEST(LoadCharacter, WholeNumbersMayBeWrittenWithAPoint) {
    const std::string file = testing::TempDir() + "load_character_whole.skin";
    const std::string data = OSGSKIN_TEST_DATA "/character/";
    const auto framesOf = [&](const char* version, const char* skipped) {
        std::ofstream(file) << "{\"osgskin\": " << version << ", \"mesh\": \"" << data
                            << "body.obj\", \"skeleton\": \"" << data
                            << "rig.bvh\", \"motions\": [{\"file\": \"" << kMove
                            << "\", \"skipFrames\": " << skipped << "}]}";
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

TEST(LoadCharacter, MakesARiggedModelWithAndWithoutSkinAfterItsName) {
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

TEST(LoadCharacter, ConvertsASceneThatOsgReads) {
    const std::string file = rigOfOsg();
    const Character character = loadCharacter(file);
    EXPECT_TRUE(character.hasBody());
    EXPECT_EQ(character.body.mesh.positions.size(), 4u);
    EXPECT_EQ(character.file, file);
    ASSERT_EQ(character.skin.skins.size(), 1u);
    EXPECT_EQ(character.skin.skins.front().drawable->getModel()->vertexCount(), 4u);
    EXPECT_EQ(character.manager, nullptr);
}

TEST(LoadCharacter, StandsInTheFirstMotionsFirstPose) {
    Character character = loadCharacter(kGood);
    const std::vector<osg::Vec3d> loaded = drawn(character);
    character.pose(character.motions.front(), 2);
    EXPECT_NE(drawn(character), loaded);
    character.pose(character.motions.front(), 0);
    EXPECT_EQ(drawn(character), loaded);
}

TEST(LoadCharacter, PoseAtASamplesTimeIsTheSample) {
    Character character = loadCharacter(kGood);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    for (std::size_t frame = 0; frame < motion.clip.frames; ++frame) {
        character.pose(motion, frame);
        const std::vector<osg::Vec3d> exact = drawn(character);
        character.poseAt(motion, motion.clip.frameTime * double(frame));
        const std::vector<osg::Vec3d> played = drawn(character);
        ASSERT_EQ(played.size(), exact.size());
        for (std::size_t i = 0; i < exact.size(); ++i)
            EXPECT_LT((played[i] - exact[i]).length(), 1e-5) << "frame " << frame;
    }
}

TEST(LoadCharacter, PosesARiggedModelsOwnAnimation) {
    Character character = loadCharacter(kTube);
    const osgSkin::CharacterMotion& wave = character.motions.front();
    character.poseAt(wave, 0.0);
    const std::vector<osg::Vec3d> start = drawn(character);
    character.poseAt(wave, 0.5);
    EXPECT_NE(drawn(character), start);
    character.poseAt(wave, 0.0);
    EXPECT_EQ(drawn(character), start);
    EXPECT_THROW(character.pose(wave, 0), osgSkin::Error) << "it has no samples";
}

TEST(LoadCharacter, RefusesAFrameBeyondTheMotion) {
    Character character = loadCharacter(kGood);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    EXPECT_NO_THROW(character.pose(motion, motion.clip.frames - 1));
    try {
        character.pose(motion, motion.clip.frames);
        ADD_FAILURE() << "it is posed";
    } catch (const osgSkin::Error& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find(kGood), std::string::npos) << said;
        EXPECT_NE(said.find("samples, found frame"), std::string::npos) << said;
    }
}

TEST(LoadCharacter, IsDrawnByTheProcessorUnlessToldOtherwise) {
    for (const bool gpu : {false, true}) {
        LoadOptions options;
        options.gpu = gpu;
        const Character character = loadCharacter(kGood, options);
        ASSERT_FALSE(character.skin.skins.empty());
        for (const auto& skin : character.skin.skins)
            EXPECT_EQ(skin.drawable->getDrawBackend() != nullptr, gpu);
    }
}

TEST(LoadCharacter, TellsBeforehandWhereItGets) {
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

TEST(LoadCharacter, AMotionFileGoesFirst) {
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

TEST(LoadCharacter, AtRestNothingPlays) {
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
TEST(LoadCharacter, TheIdentityPoseIsTheRestToTheBit) {
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

TEST(LoadCharacter, BothSourcesRefuseAlike) {
    LoadOptions dance, nobody;
    dance.motion = "dance";
    nobody.rigid = {"nobody"};
    for (const std::string& file : {kGood, kTube}) {
        const std::string motion = test::whyRefused(file, dance);
        EXPECT_EQ(motion.rfind(file + ": motion \"dance\" is neither", 0), 0u) << motion;
        EXPECT_NE(motion.find("expected one of \""), std::string::npos) << motion;
        const std::string rigid = test::whyRefused(file, nobody);
        EXPECT_EQ(rigid.rfind(file + ": ", 0), 0u) << rigid;
        EXPECT_NE(rigid.find("nobody"), std::string::npos) << rigid;
    }
}

TEST(LoadCharacter, RefusesWhatIsNotThere) {
    osg::setNotifyLevel(osg::FATAL);
    for (const char* file : {"nowhere.skin", "nowhere.glb", "nowhere.glb.skin", "nowhere.osgt"}) {
        const std::string why = test::whyRefused(file);
        EXPECT_EQ(why.rfind("nowhere.", 0), 0u) << file << ": " << why;
    }
    osg::setNotifyLevel(osg::NOTICE);
}

namespace {

using Strings = std::vector<std::string>;

/// Records the reported steps, and may cancel.
struct Recorder {
    osgSkin::Progress progress() {
        return [this](const osgSkin::ProgressStep& step) {
            if (step.what == cancelAt) throw std::runtime_error("cancelled");
            whats.push_back(step.what);
            fractions.push_back(step.fraction);
        };
    }
    /// The stages: reported texts without a colon.
    Strings stages() const {
        Strings result;
        for (const std::string& what : whats)
            if (what.find(": ") == std::string::npos) result.push_back(what);
        return result;
    }
    void expectRising() const {
        ASSERT_FALSE(fractions.empty());
        EXPECT_EQ(fractions.front(), 0.0);
        EXPECT_EQ(fractions.back(), 1.0);
        EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    }
    bool has(const std::string& what) const {
        return std::find(whats.begin(), whats.end(), what) != whats.end();
    }
    std::string cancelAt;
    Strings whats;
    std::vector<double> fractions;
};

/// Through osgDB and its `.skin` plug-in.
osg::ref_ptr<osg::Node> read(const std::string& file, const osgSkin::Progress& progress) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
    osgSkin::setProgress(*options, progress);
    return osgDB::readRefNodeFile(file, options);
}

osgSkin::Character load(const std::string& file, Recorder& recorder) {
    osgSkin::LoadOptions options;
    options.progress = recorder.progress();
    return osgSkin::loadCharacter(file, options);
}

/// Makes standard error a terminal while this lives.
class Terminal {
public:
    Terminal() : _before(dup(STDERR_FILENO)) {
        int slave = -1;
        if (openpty(&_master, &slave, nullptr, nullptr, nullptr) != 0) return;
        dup2(slave, STDERR_FILENO);
        close(slave);
    }
    ~Terminal() {
        dup2(_before, STDERR_FILENO);
        close(_before);
        close(_master);
    }
    bool works() const { return _master >= 0; }

    /// The text that has been written to it.
    std::string text() const {
        std::string result;
        pollfd ready{_master, POLLIN, 0};
        char part[1024];
        while (poll(&ready, 1, 0) > 0) {
            const ssize_t length = ::read(_master, part, sizeof part);
            if (length <= 0) break;
            result.append(part, std::size_t(length));
        }
        return result;
    }

private:
    int _before, _master = -1;
};

} // namespace

TEST(LoadProgress, TellsTheStagesOfACharacter) {
    Recorder recorder;
    load(OSGSKIN_TEST_DATA "/character/good.skin", recorder);
    EXPECT_EQ(recorder.stages(), (Strings{"mesh", "skeleton", "motion move", "motion later",
                                          "binding", "scene", "done"}));
    recorder.expectRising();
}

TEST(LoadProgress, TellsTheStagesOfARiggedModel) {
    Recorder recorder;
    load(OSGSKIN_TEST_DATA "/rig/tube.gltf.skin", recorder);
    EXPECT_EQ(recorder.stages(), (Strings{"model", "binding", "scene", "done"}));
    recorder.expectRising();
}

TEST(LoadProgress, TellsTheStagesOfARetargetedModel) {
    Recorder recorder;
    osgSkin::LoadOptions options;
    options.motion = OSGSKIN_TEST_DATA "/character/move.bvh";
    options.progress = recorder.progress();
    const osgSkin::Character character =
        osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/rig/tube.gltf", options);
    EXPECT_EQ(recorder.stages(), (Strings{"model", "motion move", "binding", "scene", "done"}));
    recorder.expectRising();
}

TEST(LoadProgress, TellsTheJointsWithinABinding) {
    Recorder recorder;
    load(OSGSKIN_DATA "/thrower.skin", recorder);
    recorder.expectRising();
    EXPECT_GT(recorder.whats.size(), 20u);
    EXPECT_TRUE(recorder.has("binding: bend of LeftForeArm"));
}

TEST(LoadProgress, TellsTheStagesOfAFit) {
    const std::string file = testing::TempDir() + "fitted_progress.skin";
    std::ofstream(file) << R"({"osgskin": 1, "mesh": ")" OSGSKIN_DATA
                           R"(/thrower.obj", "skeleton": {"fit": true}})";
    Recorder recorder;
    load(file, recorder);
    recorder.expectRising();
    const Strings& whats = recorder.whats;
    EXPECT_GT(std::count(whats.begin(), whats.end(), "skeleton: medial curves"), 10)
        << "the longest stage";
    Strings fit;
    for (const std::string& what : whats)
        if (what.rfind("skeleton: ", 0) == 0 && (fit.empty() || fit.back() != what))
            fit.push_back(what);
    EXPECT_EQ(fit, (Strings{"skeleton: surface", "skeleton: medial curves", "skeleton: facing",
                            "skeleton: joints", "skeleton: done"}));
}

TEST(LoadProgress, ThePlugInTellsTheSame) {
    for (const char* file :
         {OSGSKIN_DATA "/thrower.skin", OSGSKIN_TEST_DATA "/rig/tube.gltf.skin"}) {
        Recorder direct, throughOsgDB;
        load(file, direct);
        ASSERT_NE(read(file, throughOsgDB.progress()), nullptr);
        EXPECT_EQ(throughOsgDB.whats, direct.whats);
        EXPECT_EQ(throughOsgDB.fractions, direct.fractions);
    }
}

TEST(LoadProgress, MayCancel) {
    for (const char* at : {"binding", "binding: bend of LeftForeArm", "scene"}) {
        Recorder recorder;
        recorder.cancelAt = at;
        EXPECT_THROW(load(OSGSKIN_DATA "/thrower.skin", recorder), std::runtime_error) << at;
        EXPECT_FALSE(recorder.has("done"));
        EXPECT_EQ(read(OSGSKIN_DATA "/thrower.skin", recorder.progress()), nullptr) << at;
    }
}

TEST(LoadProgress, TheLastOneSetCounts) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    EXPECT_FALSE(osgSkin::getProgress(options));
    EXPECT_FALSE(osgSkin::getProgress(nullptr));
    Recorder first, second;
    options->getOrCreateUserDataContainer()->addUserObject(new osg::Group); // set by someone else
    osgSkin::setProgress(*options, first.progress());
    osgSkin::setProgress(*options, second.progress());
    const osg::ref_ptr<osgDB::Options> copy = options->cloneOptions();
    osgSkin::getProgress(copy)({"mesh", 0.5});
    EXPECT_TRUE(first.whats.empty());
    EXPECT_EQ(second.whats, Strings{"mesh"});
    osgSkin::setProgress(*options, {});
    EXPECT_FALSE(osgSkin::getProgress(options));
}

TEST(LoadProgress, ThePlugInWritesNothingToATerminal) {
    const Terminal terminal;
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
    // A load that takes longer than the silent period of any progress display.
    const auto slow = [](const osgSkin::ProgressStep& step) {
        if (step.what == "scene") std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    };
    ASSERT_NE(read(OSGSKIN_DATA "/thrower.skin", slow), nullptr);
    ASSERT_NE(read(OSGSKIN_DATA "/thrower.skin", {}), nullptr);
    EXPECT_EQ(terminal.text(), "");
}

TEST(ProgressLine, ShowsLongWorkOnATerminalWhileItLasts) {
    const Terminal terminal;
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
    {
        example::ProgressLine line("body.skin");
        line.show({"mesh", 0.0});
        // A stage of one second without progress is not shown at first, then it is.
        while (terminal.text().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        line.progress()({"binding: bend of Spine", 0.425});
        std::string text;
        while (text.find("body.skin: binding: bend of Spine, 42 %, ") == std::string::npos)
            text += terminal.text();
        line.show({"done", 1.0});
    }
    EXPECT_NE(terminal.text().find("body.skin: done, 100 %"), std::string::npos);
}

TEST(ProgressLine, IsSilentOnShortWork) {
    const Terminal terminal;
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
    {
        example::ProgressLine line("body.skin");
        line.show({"mesh", 0.0});
        line.show({"done", 1.0});
    }
    EXPECT_EQ(terminal.text(), "");
}

namespace {

osg::Matrixd skeletonToWorld(osg::Node& scene) {
    return test::findNodes<osgAnimation::Skeleton>(scene).at(0).toWorld;
}

/// Two updates: the first one runs the bones' callbacks.
void playTo(Character& character, double time) {
    test::updateAt(*character.root, 0.0);
    test::updateAt(*character.root, time);
}

} // namespace

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

TEST(LoadCharacter, PosesOfAPlayingCharacterAreThoseOfAnother) {
    Character character = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    Character still = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    playTo(character, 0.5);
    const auto expectSame = [&] {
        const auto a = drawn(character), b = drawn(still);
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
