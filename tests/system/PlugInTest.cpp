// SPDX-License-Identifier: MIT
// The plug-ins in a third-party host, OSG's own osgconv: they are silent, and reject libraries of
// another build instead of crashing.
#include "Command.h"
#include "ExpectContains.h"
#include "KitCheck.h"
#include "Notices.h"
#include "TextFile.h"

#include <gtest/gtest.h>

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
    test::expectContains(line, "built with " + kit + " " OSGSKIN_PROJECT_VERSION " (");
    test::expectContains(line, "0.1.7 (00000000)");
}

const char* anotherBuild() {
    return "0.1.7 (00000000)";
}
const char* thisBuild() {
    return "0.2.0 (1a2b3c4d)";
}

} // namespace

TEST_F(PlugIn, PrintsNothing) {
    for (const char* file :
         {OSGSKIN_DATA "/thrower.skin", OSGSKIN_TEST_DATA "/rig/tube.gltf.skin"}) {
        const test::CommandResult result = convert(file, "saved.osgb");
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
    }
    EXPECT_EQ(convert("saved.osgb", "saved.osgt").err, "") << "the serializers";
}

TEST_F(PlugIn, RejectsLibrariesOfAnotherBuild) {
    expectRefused(
        convert(OSGSKIN_DATA "/thrower.skin", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_BIND "' "),
        "osgdb_skin", "osgSkinBind");
}

TEST_F(PlugIn, SerializersRejectRuntimeOfAnotherBuild) {
    ASSERT_EQ(convert(OSGSKIN_TEST_DATA "/character/good.skin", "saved.osgt").status, 0);
    expectRefused(convert("saved.osgt", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_RUNTIME "' "),
                  "osgdb_serializers_osgskin", "osgSkin");
}

TEST(KitCheck, AcceptsTheSameBuild) {
    EXPECT_TRUE(plugin::mayUse("osgdb_any", {{"osgSkin", "0.2.0 (1a2b3c4d)", thisBuild}}));
}

TEST(KitCheck, RejectsOtherBuildsWithOneLine) {
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
