// SPDX-License-Identifier: MIT
// The single table of options, and its uses.
#include "Command.h"
#include "WhyRefused.h"

#include "options/OptionTable.h"

#include <gtest/gtest.h>
#include <osgSkinCharacter/CharacterOption>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

using osgSkin::CharacterOption;
using osgSkin::Option;

namespace {

std::string contentOf(const std::string& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// A row of the README's tables.
std::string rowOf(const CharacterOption& option) {
    std::string values = option.values;
    for (std::size_t at = 0; (at = values.find('|', at)) != std::string::npos; at += 4)
        values.replace(at, 1, "`, `");
    return "| `" + option.word + "` | `" + values + "` | " + option.defaultValue + " | " +
           option.meaning + " |\n";
}

} // namespace

TEST(Options, MatchTheReadme) {
    const std::string all = contentOf(OSGSKIN_DATA "/../osgPlugin/skin/FILE.md");
    const std::size_t begin = all.find("\n## Options\n");
    ASSERT_NE(begin, std::string::npos);
    const std::string section = all.substr(begin);
    for (const CharacterOption& option : osgSkin::characterOptions())
        EXPECT_NE(section.find("\n" + rowOf(option)), std::string::npos)
            << "missing in osgPlugin/skin/FILE.md:\n"
            << rowOf(option);
    std::size_t rows = 0;
    for (std::size_t at = 0; (at = section.find("\n| `", at)) != std::string::npos; ++at) ++rows;
    EXPECT_EQ(rows, osgSkin::characterOptions().size());
}

TEST(Options, AcceptOnlyTheirValues) {
    for (const Option& option : osgSkin::optionTable()) {
        osgSkin::LoadOptions options;
        for (const std::string& value : option.choices)
            EXPECT_TRUE(osgSkin::setOption(options, option.word, value)) << option.word << value;
        if (!option.set) {
            EXPECT_FALSE(osgSkin::setOption(options, option.word, "1")) << option.word;
            const osg::ref_ptr<osgDB::Options> bad = new osgDB::Options(option.word + "=");
            EXPECT_THROW(osgSkin::ReadLimits::of(bad), osgSkin::Error) << option.word;
            continue;
        }
        EXPECT_THROW(osgSkin::setOption(options, option.word, ""), osgSkin::Error) << option.word;
        if (!option.choices.empty()) {
            EXPECT_THROW(osgSkin::setOption(options, option.word, "ON"), osgSkin::Error);
        }
    }
    EXPECT_THROW(test::loadOptions("bind=best"), osgSkin::Error);
    osgSkin::LoadOptions options;
    EXPECT_FALSE(osgSkin::setOption(options, "noSuchOption", "on"));
}

TEST(Options, OfTheCallerOverrideTheFile) {
    const osgSkin::LoadOptions file = test::loadOptions("bind=paper shapes=fast avoidBody=on");
    osgSkin::LoadOptions options = test::loadOptions("shapes=none muscles=on");
    osgSkin::completeOptions(options, file);
    EXPECT_EQ(options.method, osgSkin::LoadOptions::Method::Paper);
    EXPECT_EQ(options.shapes, osgSkin::BindOptions::Shapes::None);
    EXPECT_EQ(options.avoidBody, true);
    EXPECT_EQ(options.muscles, true);
    EXPECT_EQ(options.rigid, std::nullopt);
    EXPECT_EQ(options.surfaceNormals, std::nullopt);
}

TEST(Options, MergedRigidPartsUseJointsOfTheFile) {
    const osgSkin::LoadOptions file = test::loadOptions("rigid=head");
    osgSkin::LoadOptions options = test::loadOptions("rigid=merged");
    EXPECT_TRUE(options.mergeRigid);
    osgSkin::completeOptions(options, file);
    EXPECT_TRUE(options.mergeRigid);
    EXPECT_EQ(options.rigid, std::vector<std::string>{"head"});
    options = test::loadOptions("rigid=hand");
    osgSkin::completeOptions(options, test::loadOptions("rigid=merged"));
    EXPECT_FALSE(options.mergeRigid);
}

TEST(Options, OfFilesAreOnCommandLines) {
    std::filesystem::create_directories(OSGSKIN_TEST_OUTPUT);
    for (const std::string program : {OSGSKIN_BAKE, OSGSKIN_VIEWER}) {
        const std::string help = test::runCommand(program + " --help", OSGSKIN_TEST_OUTPUT).out;
        for (const CharacterOption& option : osgSkin::characterOptions()) {
            // Programs have other meanings for these.
            if (option.word == "motion" || option.word == "formats") continue;
            EXPECT_EQ(help.find("\n  " + option.flag() + " ") != std::string::npos, option.isMember)
                << program << " " << option.flag();
        }
    }
}

TEST(Options, HaveHyphensOnCommandLines) {
    CharacterOption option;
    option.word = "avoidBody";
    EXPECT_EQ(option.flag(), "--avoid-body");
}
