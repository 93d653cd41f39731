// SPDX-License-Identifier: MIT
// A character whose players, springs and feet go on in a file as if it had never been saved.
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/FootPlacement>
#include <osgSkinMotion/LivePlayer>
#include <osgSkinMotion/SpringBones>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace osgSkin;

constexpr double kFrame = 1.0 / 30.0;
const std::string kKnight = OSGSKIN_SHARED_DATA "/characters/Knight.glb";

/// A scene that a clip moves along.
struct Moved {
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform;

    explicit Moved(osg::Node* root) { above->addChild(root); }

    std::vector<osg::Vec3d> at(double time) {
        above->preMult(find<ClipPlayer>(*above)->takeRootMatrix());
        test::updateAt(*above, time);
        std::vector<osg::Vec3d> result;
        for (const auto& found : test::findNodes<DeformableSkin>(*above))
            for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(
                     *found.node->getDeformedGeometry()->getVertexArray()))
                result.push_back(osg::Vec3d(vertex) * found.toWorld);
        return result;
    }
};

bool findSlope(const osg::Vec3d& above, const osg::Vec3d&, FootPlacement::Surface& surface) {
    surface.point.set(above.x(), above.y(), 0.03 * std::sin(3.0 * above.y()));
    surface.normal.set(0.0, -0.09 * std::cos(3.0 * above.y()), 1.0);
    return true;
}

void attachAll(Character& character) {
    const auto player = attach<ClipPlayer>(*character.root);
    player->setRoot(ClipPlayer::Root::ExtractedWithTurn);
    player->setLayer(0, {player->clip("Walking_A")});
    ClipPlayer::Layer wave{player->clip("Cheer"), 0.1, 1.3};
    wave.joints = jointsBelow(*wave.clip, "Spine");
    wave.weight = 0.0;
    player->setLayer(3, wave);
    player->fade(3, 0.8, 0.7, ClipPlayer::Easing::Smooth);
    player->addEvent(player->getLayer(0).clip, 0.3, "step", [](ClipPlayer&, std::size_t) {});
    SpringSettings springs;
    springs.chains.push_back(springsBelow(
        character.rest, {character.rest.joints[character.jointByRole("Head")].name}, {}));
    attach<SpringBones>(*character.root, springs);
    attach<FootPlacement>(*character.root)->setGround(findSlope);
}

void changeAt(osg::Node& root, int frame) {
    if (frame != 5) return;
    ClipPlayer* const player = find<ClipPlayer>(root);
    player->play({player->clip("Running_A"), 0.05, 0.9}, 0.5);
}

class SavedAt : public testing::TestWithParam<std::tuple<int, const char*>> {};

TEST_P(SavedAt, GoesOnLikeTheFigureThatWasNeverSaved) {
    if (!std::filesystem::exists(kKnight)) GTEST_SKIP() << kKnight << " is missing";
    const auto [saved, format] = GetParam();
    Character character = loadCharacter(kKnight);
    attachAll(character);
    Moved figure(character.root);
    std::vector<osg::Vec3d> vertices;
    for (int frame = 0; frame <= saved; ++frame) {
        changeAt(*figure.above, frame);
        vertices = figure.at(frame * kFrame);
    }
    const std::string file = testing::TempDir() + "going." + format;
    ASSERT_TRUE(osgDB::writeNodeFile(*figure.above, file));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
    ASSERT_TRUE(read);
    auto* const above = dynamic_cast<osg::MatrixTransform*>(read.get());
    ASSERT_TRUE(above);
    find<FootPlacement>(*above)->setGround(findSlope);
    Moved again(above->getChild(0));
    again.above = above;
    double worst = 0.0;
    osg::BoundingBoxd box;
    for (int frame = saved; frame < 30; ++frame) {
        if (frame > saved) {
            for (osg::Node* root : {figure.above.get(), above}) changeAt(*root, frame);
            vertices = figure.at(frame * kFrame);
        }
        const std::vector<osg::Vec3d> found = again.at(frame * kFrame);
        ASSERT_EQ(found.size(), vertices.size());
        for (std::size_t v = 0; v < found.size(); ++v) {
            worst = std::max(worst, (found[v] - vertices[v]).length());
            box.expandBy(vertices[v]);
        }
    }
    EXPECT_LE(worst, 1e-6 * (box.zMax() - box.zMin()));
    RecordProperty("worst", std::to_string(worst / (box.zMax() - box.zMin())));
}

INSTANTIATE_TEST_SUITE_P(Frames, SavedAt,
                         testing::Values(std::tuple(0, "osgb"), std::tuple(3, "osgb"),
                                         std::tuple(7, "osgb"), std::tuple(14, "osgb"),
                                         std::tuple(25, "osgb"), std::tuple(14, "osgx")));

TEST(SavedPlayer, KeepsClipsAndManager) {
    if (!std::filesystem::exists(kKnight)) GTEST_SKIP() << kKnight << " is missing";
    Character character = loadCharacter(kKnight);
    const osg::ref_ptr<ClipPlayer> player = attach<ClipPlayer>(*character.root);
    player->play({player->clip(character.motions[0].name())});
    const std::string file = testing::TempDir() + "player.osgb";
    const test::Notices notices;
    ASSERT_TRUE(osgDB::writeNodeFile(*character.root, file));
    Character again = loadCharacter(file);
    EXPECT_EQ(notices.warnings(), "");
    EXPECT_EQ(again.motions.size(), character.motions.size());
    EXPECT_TRUE(again.manager);
    ASSERT_TRUE(find<ClipPlayer>(*again.root));
    const auto& clip = find<ClipPlayer>(*again.root)->getLayer(0).clip;
    ASSERT_TRUE(clip);
    EXPECT_EQ(clip->name(), character.motions[0].name());
}

TEST(SavedPlayer, OfLiveMotionLeavesTheManager) {
    if (!std::filesystem::exists(kKnight)) GTEST_SKIP() << kKnight << " is missing";
    Character character = loadCharacter(kKnight);
    attach<LivePlayer>(*character.root, LiveRetarget(character.rest, character.rest));
    const std::string file = testing::TempDir() + "live.osgb";
    const test::Notices notices;
    ASSERT_TRUE(osgDB::writeNodeFile(*character.root, file));
    EXPECT_TRUE(notices.say("a LivePlayer is not saved")) << notices.text();
    const osg::ref_ptr<osg::Node> again = osgDB::readRefNodeFile(file);
    ASSERT_TRUE(again);
    const auto place = [&](double time) {
        test::updateAt(*again, time);
        return test::findNodes<DeformableSkin>(*again).at(0).node->getBoundingBox().center();
    };
    const osg::Vec3 first = place(0.0);
    EXPECT_GT((place(0.4) - first).length(), 1e-4) << "an animation plays";
    detach<LivePlayer>(*again);
    EXPECT_FALSE(find<LivePlayer>(*again));
}

} // namespace
