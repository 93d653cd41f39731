// SPDX-License-Identifier: MIT
// Who loads a character through osgDB can be told how far it has come.
#include <osgSkinImport/LoadProgress>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace {

struct Recorder : osgSkin::LoadProgress {
    void step(const std::string& file, const std::string& what, std::size_t done,
              std::size_t total) override {
        if (what == giveUpAt) throw std::runtime_error("given up");
        EXPECT_FALSE(file.empty());
        steps.push_back(what);
        dones.push_back(done);
        totals.push_back(total);
    }
    void within(const std::string&, const std::string& what, double share) override {
        if (what == giveUpAt) throw std::runtime_error("given up");
        parts.push_back(what);
        shares.push_back(share);
    }
    std::string giveUpAt;
    std::vector<std::string> steps;
    std::vector<std::size_t> dones, totals;
    std::vector<std::string> parts; ///< of long steps
    std::vector<double> shares;
};

osg::ref_ptr<osg::Node> read(const std::string& file, osgSkin::LoadProgress* progress) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
    osgSkin::setLoadProgress(*options, progress);
    return osgDB::readRefNodeFile(file, options);
}

void expectCounts(const Recorder& recorder) {
    for (std::size_t i = 0; i < recorder.dones.size(); ++i) {
        EXPECT_EQ(recorder.dones[i], i);
        EXPECT_EQ(recorder.totals[i], recorder.dones.size() - 1);
    }
}

} // namespace

TEST(LoadProgress, IsToldTheStepsOfACharacter) {
    const osg::ref_ptr<Recorder> recorder = new Recorder;
    ASSERT_NE(read(OSGSKIN_TEST_DATA "/character/good.skin", recorder), nullptr);
    EXPECT_EQ(recorder->steps,
              (std::vector<std::string>{"mesh", "skeleton", "binding", "motion move",
                                        "motion later", "scene", "done"}));
    expectCounts(*recorder);
}

TEST(LoadProgress, IsToldTheJointsWithinABinding) {
    const osg::ref_ptr<Recorder> recorder = new Recorder;
    ASSERT_NE(read(OSGSKIN_DATA "/thrower.skin", recorder), nullptr);
    EXPECT_GT(recorder->parts.size(), 15u);
    EXPECT_NE(std::find(recorder->parts.begin(), recorder->parts.end(), "bend of LeftForeArm"),
              recorder->parts.end());
    EXPECT_TRUE(std::is_sorted(recorder->shares.begin(), recorder->shares.end()));
    EXPECT_EQ(recorder->shares.front(), 0.0);
    EXPECT_EQ(recorder->shares.back(), 1.0);

    const osg::ref_ptr<Recorder> leaver = new Recorder;
    leaver->giveUpAt = "bend of LeftForeArm";
    EXPECT_EQ(read(OSGSKIN_DATA "/thrower.skin", leaver), nullptr);
    EXPECT_EQ(leaver->steps.back(), "binding");
}

TEST(LoadProgress, IsToldTheStagesOfAFit) {
    const std::string file = testing::TempDir() + "fitted_progress.skin";
    std::ofstream(file) << R"({"osgskin": 1, "mesh": ")" OSGSKIN_DATA
                           R"(/thrower.obj", "skeleton": {"fit": true}})";
    const osg::ref_ptr<Recorder> recorder = new Recorder;
    ASSERT_NE(read(file, recorder), nullptr);
    const std::vector<std::string> stages{"surface", "medial curves", "facing", "joints", "done"};
    const auto binding = std::find(recorder->parts.begin(), recorder->parts.end(), "welding");
    ASSERT_NE(binding, recorder->parts.end());
    std::vector<std::string> fit(recorder->parts.begin(), binding);
    EXPECT_GT(std::count(fit.begin(), fit.end(), "medial curves"), 10) << "the longest stage";
    EXPECT_TRUE(std::is_sorted(recorder->shares.begin(),
                               recorder->shares.begin() + std::ptrdiff_t(fit.size())));
    EXPECT_EQ(recorder->shares[fit.size() - 1], 1.0);
    fit.erase(std::unique(fit.begin(), fit.end()), fit.end());
    EXPECT_EQ(fit, stages);
}

TEST(LoadProgress, IsToldTheStepsOfARiggedModel) {
    const osg::ref_ptr<Recorder> recorder = new Recorder;
    ASSERT_NE(read(OSGSKIN_TEST_DATA "/rig/tube.gltf.skin", recorder), nullptr);
    EXPECT_EQ(recorder->steps, (std::vector<std::string>{"model", "binding", "scene", "done"}));
    expectCounts(*recorder);
}

TEST(LoadProgress, MayGiveUp) {
    const osg::ref_ptr<Recorder> recorder = new Recorder;
    recorder->giveUpAt = "binding";
    EXPECT_EQ(read(OSGSKIN_TEST_DATA "/character/good.skin", recorder), nullptr);
    EXPECT_EQ(recorder->steps.back(), "skeleton");
}

TEST(LoadProgress, TheLastOneSetCounts) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    EXPECT_EQ(osgSkin::getLoadProgress(options), nullptr);
    EXPECT_EQ(osgSkin::getLoadProgress(nullptr), nullptr);
    const osg::ref_ptr<Recorder> first = new Recorder, second = new Recorder;
    osgSkin::setLoadProgress(*options, first);
    osgSkin::setLoadProgress(*options, second);
    EXPECT_EQ(osgSkin::getLoadProgress(options), second);
    osgSkin::setLoadProgress(*options, nullptr);
    EXPECT_EQ(osgSkin::getLoadProgress(options), nullptr);
}
