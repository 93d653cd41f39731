// SPDX-License-Identifier: MIT
#include "PlayedFigure.h"

#include <osgSkin/CharacterGroup>

#include <osg/NodeCallback>
#include <osg/Switch>

#include <gtest/gtest.h>

#include <vector>

namespace {

using osgSkin::CharacterGroup;
using played::Character;

/// Characters in a group, each at another time of its clip.
struct Street {
    explicit Street(osg::Group* group, std::size_t count = 12) : scene(group) {
        for (std::size_t i = 0; i < count; ++i) {
            characters.emplace_back(played::someClip(20 + i, 0.5));
            const osg::ref_ptr<osg::MatrixTransform> place =
                new osg::MatrixTransform(osg::Matrix::translate(10.0 * double(i), 0, 0));
            place->addChild(characters.back().scene);
            scene->addChild(place);
        }
    }
    void show(double time) {
        test::updateAt(*scene, time);
        test::cull(*scene, true);
    }
    std::vector<osg::Vec3> vertices() {
        std::vector<osg::Vec3> all;
        for (const Character& character : characters)
            for (const osg::Vec3& vertex : test::verticesOf(*character.skin)) all.push_back(vertex);
        return all;
    }
    osg::ref_ptr<osg::Group> scene;
    std::vector<Character> characters;
};

/// Notes whether it ran.
class Noting : public osg::NodeCallback {
public:
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        ++count;
        isPlain = dynamic_cast<osgUtil::UpdateVisitor*>(nv) != nullptr;
        traverse(node, nv);
    }
    int count = 0;
    bool isPlain = false; ///< the application's own update visitor
};

TEST(CharacterGroup, PosesAsAnyGroup) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(0.0);
    Street street(group), plain(new osg::Group);
    for (int frame = 0; frame < 30; ++frame) {
        const double time = frame / 30.0;
        street.show(time);
        plain.show(time);
        ASSERT_EQ(street.vertices(), plain.vertices()) << frame;
        EXPECT_EQ(group->getBound(), plain.scene->getBound()) << frame;
    }
    EXPECT_EQ(group->ordinaryChildren(), 0u);
}

TEST(CharacterGroup, DeformsWhatWasSeen) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(0.0);
    Street street(group, 2);
    street.show(0.0);
    street.show(0.1);
    test::updateAt(*group, 0.2);
    for (const Character& character : street.characters)
        EXPECT_FALSE(character.skin->needsDeform());
}

TEST(CharacterGroup, LeavesCallbacksOfApplicationsToTheUpdateTraversal) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(0.0);
    Street street(group), plain(new osg::Group);
    street.show(0.0);
    street.show(0.1);
    // On a bone, deep below, and long after the start.
    const osg::ref_ptr<Noting> noting = new Noting;
    Character::findBone(*street.characters[4].skeleton, "end")->addUpdateCallback(noting);
    street.show(0.2);
    EXPECT_EQ(noting->count, 1);
    EXPECT_TRUE(noting->isPlain);
    EXPECT_EQ(group->ordinaryChildren(), 1u);
    for (const double time : {0.0, 0.1, 0.2}) plain.show(time);
    EXPECT_EQ(street.vertices(), plain.vertices());
    Character::findBone(*street.characters[4].skeleton, "end")->removeUpdateCallback(noting);
    group->dirty();
    street.show(0.3);
    street.show(0.4);
    EXPECT_EQ(group->ordinaryChildren(), 0u);
}

TEST(CharacterGroup, UpdatesCharactersWithOneCallbackInTurn) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    Street street(group, 4);
    street.characters[2].scene->addUpdateCallback(street.characters[1].scene->getUpdateCallback());
    street.show(0.0);
    street.show(0.1);
    EXPECT_EQ(group->ordinaryChildren(), 1u);
}

TEST(CharacterGroup, NoticesChildrenThatComeAndGo) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(0.0);
    Street street(group, 5);
    street.show(0.0);
    Character late(played::someClip(9, 0.5)), alone(played::someClip(9, 0.5));
    group->removeChild(0u, 2u);
    group->addChild(late.scene);
    for (const double time : {0.1, 0.2, 0.3}) {
        street.show(time);
        alone.update(time);
        EXPECT_EQ(test::verticesOf(*late.skin), test::verticesOf(*alone.skin));
    }
    EXPECT_EQ(group->ordinaryChildren(), 0u);
}

TEST(CharacterGroup, LeavesWhatIsSwitchedOff) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    Character character(played::someClip(9, 0.5));
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    choice->addChild(character.scene, true);
    group->addChild(choice);
    for (const double time : {0.1, 0.2}) test::updateAt(*group, time);
    const auto before = test::verticesOf(*character.skin);
    choice->setAllChildrenOff();
    test::updateAt(*group, 0.3);
    EXPECT_EQ(test::verticesOf(*character.skin), before);
    choice->setAllChildrenOn();
    test::updateAt(*group, 0.3);
    EXPECT_NE(test::verticesOf(*character.skin), before);
}

/// The frames, of so many, in which a character moves; each time it must be where any group has it.
std::vector<int> movedFrames(CharacterGroup& group, int frames, bool looks) {
    Street street(&group), plain(new osg::Group);
    std::vector<int> moved;
    std::vector<osg::Vec3> before;
    for (int frame = 0; frame < frames; ++frame) {
        const double time = frame / 30.0;
        street.show(time);
        plain.show(time);
        if (looks) {
            osg::NodeVisitor visitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN);
            group.accept(visitor);
            EXPECT_EQ(street.vertices(), plain.vertices()) << frame;
        }
        const std::vector<osg::Vec3> now = test::verticesOf(*street.characters[0].skin);
        if (now != before) moved.push_back(frame);
        if (now != before) {
            EXPECT_EQ(now, test::verticesOf(*plain.characters[0].skin)) << frame;
        }
        before = now;
    }
    return moved;
}

TEST(CharacterGroup, UpdatesSmallCharactersInEveryEighthFrame) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(1e6);
    const std::vector<int> moved = movedFrames(*group, 26, false);
    ASSERT_GE(moved.size(), 4u);
    for (std::size_t i = moved.size() - 2; i < moved.size(); ++i)
        EXPECT_EQ(moved[i] - moved[i - 1], 8);
}

TEST(CharacterGroup, ShowsTheTimesPoseToVisitors) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(1e6);
    EXPECT_EQ(movedFrames(*group, 20, true).size(), 20u);
}

TEST(CharacterGroup, UpdatesInEachFrameWhatNoCameraHasSeen) {
    const osg::ref_ptr<CharacterGroup> group = new CharacterGroup;
    group->setFullRateSize(1e6);
    Street street(group, 3);
    std::vector<osg::Vec3> before;
    for (const double time : {0.1, 0.2, 0.3, 0.4}) {
        test::updateAt(*group, time);
        const std::vector<osg::Vec3> now = street.vertices();
        EXPECT_NE(now, before);
        before = now;
    }
}

} // namespace
