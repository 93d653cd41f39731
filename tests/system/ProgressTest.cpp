// SPDX-License-Identifier: MIT
// Who loads a character through osgDB can be told how far it has come.
#include <osgSkinImport/LoadProgress>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

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
    std::string giveUpAt;
    std::vector<std::string> steps;
    std::vector<std::size_t> dones, totals;
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
