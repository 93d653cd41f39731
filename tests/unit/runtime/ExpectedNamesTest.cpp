// SPDX-License-Identifier: MIT
// Suggestions and lists in messages about unknown names.
#include <osgSkin/ExpectedNames>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using osgSkin::expectedNames;
using osgSkin::nearestName;

const std::vector<std::string> kKnown = {"bind",      "shapes",         "avoidBody",
                                         "maxFileMB", "mixamorig:Head", "Idle Loop"};

struct Word {
    const char* name;
    const char* word;
    const char* meant; ///< empty: none
};

std::ostream& operator<<(std::ostream& out, const Word& word) {
    return out << word.name;
}

class NearestName : public testing::TestWithParam<Word> {};

} // namespace

TEST_P(NearestName, IsSuggested) {
    EXPECT_EQ(nearestName(GetParam().word, kKnown), GetParam().meant);
}

INSTANTIATE_TEST_SUITE_P(Words, NearestName,
                         testing::Values(Word{"LetterMissing", "shape", "shapes"},
                                         Word{"LetterTooMany", "shappes", "shapes"},
                                         Word{"OtherLetter", "shopes", "shapes"},
                                         Word{"Swapped", "bnid", "bind"},
                                         Word{"TwoInALongName", "avodBdy", "avoidBody"},
                                         Word{"TwoInAShortName", "bold", ""},
                                         Word{"OtherCase", "AVOIDBODY", "avoidBody"},
                                         Word{"WithoutItsPrefix", "head", "mixamorig:Head"},
                                         Word{"OtherPrefix", "rig:Head", "mixamorig:Head"},
                                         Word{"OnlyAPrefix", "mixamorig:", ""},
                                         Word{"Known", "bind", "bind"}, Word{"Other", "gpu", ""},
                                         Word{"None", "", ""}),
                         [](const auto& word) { return std::string(word.param.name); });

TEST(NearestName, AcceptsNamesOfAnyLength) {
    const std::string longName(10'000'000, 'n');
    EXPECT_EQ(nearestName(longName, {longName, "n"}), "");
    EXPECT_EQ(nearestName("shape", {longName, "shapes"}), "shapes");
}

TEST(ClipsMeant, AreThoseBehindABarWhereNoneHasTheName) {
    using Found = std::vector<std::size_t>;
    const std::vector<std::string> known = {"Rig|Walk", "Walk", "A|Run", "B|Run", "C|Sit_C"};
    EXPECT_EQ(osgSkin::clipsMeant("Walk", known), Found{1});
    EXPECT_EQ(osgSkin::clipsMeant("Rig|Walk", known), Found{0});
    EXPECT_EQ(osgSkin::clipsMeant("Run", known), (Found{2, 3}));
    EXPECT_EQ(osgSkin::clipsMeant("Sit", known), Found{4});
    EXPECT_EQ(osgSkin::clipsMeant("Rig", known), Found{});
}

TEST(ExpectedNames, ListsKnownNames) {
    EXPECT_EQ(expectedNames("rnu", {"walk", "run"}),
              R"(, expected one of "walk", "run"; did you mean "run"?)");
    EXPECT_EQ(expectedNames("fly", {"walk", "run"}), R"(, expected one of "walk", "run")");
    EXPECT_EQ(expectedNames("fly", {}), "");
}

TEST(ExpectedNames, TruncatesLongLists) {
    std::vector<std::string> joints;
    for (int j = 0; j < 5000; ++j) joints.push_back("joint" + std::to_string(j));
    const std::string text = expectedNames("joint4999x", joints);
    EXPECT_LT(text.size(), 3200u);
    EXPECT_NE(text.find("\"joint0\", \"joint1\", "), std::string::npos) << text;
    EXPECT_NE(text.find(", ... (5000 in all); did you mean \"joint4999\"?"), std::string::npos)
        << text;
}
