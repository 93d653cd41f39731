// SPDX-License-Identifier: MIT
// Who loads a character through osgDB can be told how far it has come.
#include "load/LoadSteps.h"

#include <osgSkinImport/LoadProgress>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <poll.h>
#include <pty.h>
#include <unistd.h>

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

/// Standard error is a terminal while this lives.
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

    /// What has been written to it.
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

TEST(LoadProgress, ALongStepIsShownOnATerminalWhileItLasts) {
    const Terminal terminal;
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
    {
        osgSkin::LoadSteps steps("body.skin", 2, nullptr);
        steps.begin("mesh");
        // One second of nothing is not shown; then it is, though the step says nothing itself.
        while (terminal.text().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        steps.begin("binding");
        steps.within("bend of Spine", 0.425);
        std::string text;
        while (text.find("binding: bend of Spine, 42 % (1 of 2), ") == std::string::npos)
            text += terminal.text();
        steps.finish();
    }
    EXPECT_NE(terminal.text().find("body.skin: done (2 of 2)"), std::string::npos);
}

TEST(LoadProgress, AShortLoadIsSilent) {
    const Terminal terminal;
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
    {
        osgSkin::LoadSteps steps("body.skin", 1, nullptr);
        steps.begin("mesh");
        steps.finish();
    }
    EXPECT_EQ(terminal.text(), "");
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
