// SPDX-License-Identifier: MIT
// An application can receive progress of a load; only our programs print it.
#include "ExpectContains.h"
#include "ProgressLine.h"
#include "SkinFiles.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/ProgressOption>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osgDB/ReadFile>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

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

TEST(LoadProgress, ReportsStages) {
    const struct {
        const char *file, *motion;
        Strings stages;
    } cases[] = {
        {OSGSKIN_TEST_DATA "/character/good.skin",
         nullptr,
         {"mesh", "skeleton", "motion move", "motion later", "binding", "scene", "done"}},
        {OSGSKIN_TEST_DATA "/rig/tube.gltf.skin", nullptr, {"model", "binding", "scene", "done"}},
        {OSGSKIN_TEST_DATA "/rig/tube.gltf",
         OSGSKIN_TEST_DATA "/character/move.bvh",
         {"model", "motion move", "binding", "scene", "done"}}};
    for (const auto& c : cases) {
        Recorder recorder;
        osgSkin::LoadOptions options;
        if (c.motion) options.motion = c.motion;
        options.progress = recorder.progress();
        osgSkin::loadCharacter(c.file, options);
        EXPECT_EQ(recorder.stages(), c.stages) << c.file;
        recorder.expectRising();
    }
}

TEST(LoadProgress, ReportsJointsOfBinding) {
    Recorder recorder;
    load(OSGSKIN_DATA "/thrower.skin", recorder);
    recorder.expectRising();
    EXPECT_GT(recorder.whats.size(), 20u);
    EXPECT_TRUE(recorder.has("binding: bend of LeftForeArm"));
}

TEST(LoadProgress, ReportsStagesOfFit) {
    const std::string file = test::saveSkin(testing::TempDir() + "fitted_progress.skin", {},
                                            OSGSKIN_DATA "/thrower.obj", R"({"fit": true})");
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

TEST(LoadProgress, PlugInReportsTheSame) {
    for (const char* file :
         {OSGSKIN_DATA "/thrower.skin", OSGSKIN_TEST_DATA "/rig/tube.gltf.skin"}) {
        Recorder direct, throughOsgDB;
        load(file, direct);
        ASSERT_NE(read(file, throughOsgDB.progress()), nullptr);
        EXPECT_EQ(throughOsgDB.whats, direct.whats);
        EXPECT_EQ(throughOsgDB.fractions, direct.fractions);
    }
}

TEST(LoadProgress, ExceptionCancelsLoad) {
    for (const char* at : {"binding", "binding: bend of LeftForeArm", "scene"}) {
        Recorder recorder;
        recorder.cancelAt = at;
        EXPECT_THROW(load(OSGSKIN_DATA "/thrower.skin", recorder), std::runtime_error) << at;
        EXPECT_FALSE(recorder.has("done"));
        EXPECT_EQ(read(OSGSKIN_DATA "/thrower.skin", recorder.progress()), nullptr) << at;
    }
}

TEST(LoadProgress, SetProgressReplacesEarlierOne) {
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

TEST(LoadProgress, PlugInPrintsNothing) {
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

TEST(ProgressLine, ShowsLongWork) {
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
    test::expectContains(terminal.text(), "body.skin: done, 100 %");
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
