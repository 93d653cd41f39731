// SPDX-License-Identifier: MIT
// Every recipe's picture is the one on its page, and the page has every recipe.
#include "Recipes.h"
#include "Pixels.h"
#include "Samples.h"
#include "UpdateAt.h"

#include <osgSkin/SetMorph>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

const std::string kPictures = OSGSKIN_EXAMPLES "/pictures/recipes/";
const std::string kSamples = OSGSKIN_TEST_OUTPUT "/recipes";
const std::string kGiants = OSGSKIN_TEST_OUTPUT "/giants";

/// Writes the samples again, 40 times as large.
void writeGiants() {
    const std::filesystem::path folder = kGiants;
    std::filesystem::remove_all(folder);
    std::filesystem::copy(kSamples, folder);
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".skin") continue;
        std::ifstream in(file.path());
        std::string text((std::istreambuf_iterator<char>(in)), {});
        in.close();
        std::ofstream(file.path()) << text.insert(text.find('{') + 1, " \"unit\": 40,");
    }
}

class Recipes : public testing::TestWithParam<Recipe> {
protected:
    static void SetUpTestSuite() {
        writeSamples(OSGSKIN_DATA, kSamples);
        writeGiants();
    }
};

} // namespace

std::ostream& operator<<(std::ostream& out, const Recipe& recipe) {
    return out << recipe.name;
}

TEST_P(Recipes, MatchThePicturesOnTheirPage) {
    const osg::ref_ptr<osg::Image> expected =
        osgDB::readRefImageFile(kPictures + GetParam().name + ".png");
    ASSERT_TRUE(expected);
    const osg::ref_ptr<osg::Image> picture = pictureOf(GetParam(), {}, kSamples);
    ASSERT_EQ(expected->s(), picture->s());
    ASSERT_EQ(expected->t(), picture->t());
    ASSERT_EQ(expected->getPixelFormat(), GLenum(GL_RGB));
    // Drivers may smooth edges and rasterise shadows otherwise.
    EXPECT_LE(test::unlikePixels(*picture, *expected), test::pixelCount(*expected) / 300);
}

/// A saved character, a rigged model whose joints are not recognised, and a file that is missing.
TEST_P(Recipes, ShowAnyCharacterOrSayWhyNot) {
    for (const std::string& file :
         {kSamples + "/face.osgb", std::string(OSGSKIN_TEST_DATA "/rig/tube.gltf"),
          kSamples + "/missing.glb"}) {
        try {
            const Stage stage = stageOf(GetParam(), file, kSamples);
            test::updateAt(*stage.scene, 0.0);
            test::updateAt(*stage.scene, 0.1);
        } catch (const std::exception& error) {
            EXPECT_NE(std::string(error.what()).find(' '), std::string::npos) << error.what();
        }
    }
}

TEST_P(Recipes, ShowAGiantAsTheyShowAMan) {
    const std::string sample = GetParam().sample;
    if (std::filesystem::path(sample).extension() != ".skin") return; // others have no unit
    if (GetParam().name == std::string("fallDown")) return; // Bullet's margins have a unit
    const osg::ref_ptr<osg::Image> man = pictureOf(GetParam(), kSamples + "/" + sample, kSamples);
    const osg::ref_ptr<osg::Image> giant = pictureOf(GetParam(), kGiants + "/" + sample, kSamples);
    EXPECT_LE(test::unlikePixels(*man, *giant), test::pixelCount(*man) / 50);
}

TEST(RecipesWithoutClips, SayThatThereAreNone) {
    writeSamples(OSGSKIN_DATA, kSamples);
    for (const Recipe& recipe : recipes()) {
        const std::string name = recipe.name;
        if (name == "chooseClip" || name == "fadeClips" || name == "climbStairs") {
            EXPECT_THROW(stageOf(recipe, kSamples + "/face.osgb", kSamples), std::exception);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Recipes, testing::ValuesIn(recipes()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(RecipeSamples, HaveTheClipsAndMorphsOfTheRecipes) {
    writeSamples(OSGSKIN_DATA, kSamples);
    const osgSkin::Character walker = osgSkin::loadCharacter(kSamples + "/walker.skin");
    ASSERT_EQ(walker.motions.size(), 2u);
    EXPECT_EQ(walker.motions[0].name(), "walk");
    EXPECT_EQ(walker.motions[1].name(), "wave");
    for (const osgSkin::CharacterMotion& motion : walker.motions)
        EXPECT_NEAR(motion.duration(), 1.0, 1e-4);
    const osgSkin::Character coarse = osgSkin::loadCharacter(kSamples + "/coarse.skin");
    EXPECT_LT(coarse.body.mesh.positions.size(), walker.body.mesh.positions.size() / 3);
    EXPECT_TRUE(coarse.notes.empty());
    const osg::ref_ptr<osg::Node> face = osgDB::readRefNodeFile(kSamples + "/face.osgb");
    ASSERT_TRUE(face);
    EXPECT_EQ(osgSkin::morphNames(*face), (std::vector<std::string>{"smile", "surprise"}));
}
