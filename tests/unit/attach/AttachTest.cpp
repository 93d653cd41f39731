// SPDX-License-Identifier: MIT
// The one way to attach, find, save, copy and remove what moves or reads a character.
#include "GltfBuilder.h"
#include "UpdateAt.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/FaceControls>
#include <osgSkinMotion/FootPlacement>
#include <osgSkinMotion/HitBoxes>
#include <osgSkinMotion/LivePlayer>
#include <osgSkinMotion/SpringBones>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace osgSkin;

/// A column of three joints with a clip.
Character makeColumn() {
    test::GltfColumn column;
    column.animate("nod", column.joints[0], "rotation", {0, 1}, test::GltfColumn::turns({0, 30}));
    return loadCharacter(column.save("attached.gltf"));
}

SpringSettings someSprings(const Character& character) {
    SpringSettings settings;
    settings.chains.push_back(springsBelow(character.rest, {"middle"}, {}));
    return settings;
}

std::vector<Constraint> someConstraints() {
    Constraint roll;
    roll.joint.name = "top";
    roll.source.name = "base";
    return {roll};
}

/// All update callbacks of a scene, by class.
std::string callbacksOf(osg::Node& root) {
    struct List : osg::NodeVisitor {
        List() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override {
            for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
                text += std::string(c->className()) + ' ';
            text += '\n';
            traverse(node);
        }
        std::string text;
    } list;
    root.accept(list);
    return list.text;
}

osg::ref_ptr<osg::Node> written(const osg::Node& root) {
    const std::string file = testing::TempDir() + "attached.osgb";
    EXPECT_TRUE(osgDB::writeNodeFile(root, file));
    return osgDB::readRefNodeFile(file);
}

template <typename Kind, typename Attach>
void expectOneWay(const Attach& attachTo) {
    Character character = makeColumn();
    osg::Node& root = *character.root;
    test::updateAt(root, 0.0);
    const std::string before = callbacksOf(root);
    EXPECT_FALSE(find<Kind>(root));
    EXPECT_FALSE(detach<Kind>(root));
    const osg::ref_ptr<Kind> first = attachTo(root, character);
    EXPECT_EQ(find<Kind>(root), first);
    const osg::ref_ptr<Kind> second = attachTo(root, character);
    EXPECT_EQ(find<Kind>(root), second) << "it replaces the first";
    EXPECT_EQ(attachmentsOf(root).size(), 1u);
    test::updateAt(root, 0.1);

    const osg::ref_ptr<osg::Node> copy = osg::clone(&root, osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(find<Kind>(*copy));
    EXPECT_NE(find<Kind>(*copy), second);
    test::updateAt(*copy, 0.1);

    const osg::ref_ptr<osg::Node> read = written(root);
    ASSERT_TRUE(read);
    EXPECT_TRUE(find<Kind>(*read));
    test::updateAt(*read, 0.1);

    EXPECT_TRUE(detach<Kind>(root));
    EXPECT_FALSE(find<Kind>(root));
    EXPECT_EQ(callbacksOf(root), before);
    attach(root, *second); // again
    EXPECT_EQ(find<Kind>(root), second);

    const osg::ref_ptr<osg::Group> nothing = new osg::Group;
    nothing->setName("nothing");
    if (std::is_same_v<Kind, FaceControls>) return; // of any scene
    try {
        attachTo(*nothing, character);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("\"nothing\""), std::string::npos) << error.what();
    }
}

TEST(Attach, SpringBonesInTheOneWay) {
    expectOneWay<SpringBones>([](osg::Node& root, const Character& character) {
        return attach<SpringBones>(root, someSprings(character));
    });
}

TEST(Attach, ConstraintsInTheOneWay) {
    expectOneWay<Constraints>([](osg::Node& root, const Character&) {
        return attach<Constraints>(root, someConstraints());
    });
}

TEST(Attach, NamesTheLikelyJointOfAMisspeltOne) {
    const Character character = makeColumn();
    std::vector<Constraint> constraints = someConstraints();
    constraints[0].source.name = "bace";
    SpringSettings springs = someSprings(character);
    springs.chains[0].joints[0].name = "midle";
    const auto expectMeant = [](const char* meant, const auto& attachTo) {
        try {
            attachTo();
            ADD_FAILURE() << meant;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(meant), std::string::npos) << error.what();
        }
    };
    expectMeant("did you mean \"base\"?",
                [&] { attach<Constraints>(*character.root, constraints); });
    expectMeant("did you mean \"middle\"?", [&] { attach<SpringBones>(*character.root, springs); });
    EXPECT_FALSE(find<Constraints>(*character.root));
    EXPECT_FALSE(find<SpringBones>(*character.root));
}

TEST(Attach, HitBoxesInTheOneWay) {
    expectOneWay<HitBoxes>(
        [](osg::Node& root, const Character&) { return attach<HitBoxes>(root); });
}

TEST(Attach, FaceControlsInTheOneWay) {
    expectOneWay<FaceControls>(
        [](osg::Node& root, const Character&) { return attach<FaceControls>(root); });
}

TEST(Attach, ClipPlayersInTheOneWay) {
    expectOneWay<ClipPlayer>(
        [](osg::Node& root, const Character&) { return attach<ClipPlayer>(root); });
}

TEST(Attach, LivePlayersInTheOneWay) {
    expectOneWay<LivePlayer>([](osg::Node& root, const Character& character) {
        return attach<LivePlayer>(root, LiveRetarget(character.rest, character.rest));
    });
}

TEST(Attach, FootPlacementNeedsLegs) {
    Character character = makeColumn();
    EXPECT_THROW(attach<FootPlacement>(*character.root), Error);
    EXPECT_TRUE(attachmentsOf(*character.root).empty());
}

TEST(Attach, ActsInOneOrder) {
    for (const bool reversed : {false, true}) {
        Character character = makeColumn();
        osg::Node& root = *character.root;
        if (reversed) {
            attach<HitBoxes>(root);
            attach<FaceControls>(root);
            attach<SpringBones>(root, someSprings(character));
        }
        attach<Constraints>(root, someConstraints());
        if (!reversed) attach<SpringBones>(root, someSprings(character));
        attach<ClipPlayer>(root);
        if (!reversed) {
            attach<FaceControls>(root);
            attach<HitBoxes>(root);
        }
        const std::string order = callbacksOf(root);
        EXPECT_EQ(order.rfind("HitBoxes FaceControls ClipPlayer AutoPlayManager", 0), 0u) << order;
        EXPECT_NE(order.find("\nSpringBones Constraints "), std::string::npos) << order;
    }
}

TEST(Attach, RefusesTwoFiguresAtATime) {
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    Character one = makeColumn(), other = makeColumn();
    both->addChild(one.root);
    both->addChild(other.root);
    EXPECT_THROW(attach<ClipPlayer>(*both), Error);
    attach<ClipPlayer>(*one.root);
    EXPECT_TRUE(find<ClipPlayer>(*one.root));
    EXPECT_FALSE(find<ClipPlayer>(*other.root));
}

TEST(Attach, ManagersOfHiddenFiguresPauseToo) {
    Character character = makeColumn();
    character.root->setNodeMask(0);
    const auto player = attach<ClipPlayer>(*character.root);
    EXPECT_TRUE(player->clip("nod"));
    character.root->setNodeMask(~0u);
    const auto tilt = [&] { return character.bone("base")->getMatrix().getRotate().w(); };
    test::updateAt(*character.root, 0.0);
    const double atStart = tilt();
    test::updateAt(*character.root, 0.5);
    EXPECT_NEAR(tilt(), atStart, 1e-9);
}

/// A manager pauses below a player, and plays again without.
TEST(Attach, AnimationManagersPauseBelowAPlayer) {
    Character character = makeColumn();
    const auto tilt = [&] { return character.bone("base")->getMatrix().getRotate().w(); };
    test::updateAt(*character.root, 0.0);
    const double atStart = tilt();
    const osg::ref_ptr<ClipPlayer> player = attach<ClipPlayer>(*character.root);
    EXPECT_TRUE(player->clip("nod"));
    EXPECT_THROW(player->clip("nodd"), Error);
    test::updateAt(*character.root, 0.5);
    EXPECT_NEAR(tilt(), atStart, 1e-9);
    character.play("nod");
    EXPECT_EQ(player->getLayer(0).clip, player->clip("nod"));
    EXPECT_TRUE(detach<ClipPlayer>(*character.root));
    character.play("nod");
    test::updateAt(*character.root, 1.0);
    test::updateAt(*character.root, 1.5);
    EXPECT_LT(tilt(), atStart - 1e-3);
}

} // namespace
