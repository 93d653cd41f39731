// SPDX-License-Identifier: MIT
// Characters whose parts are copied.
#include "BentClip.h"
#include "Notices.h"

#include <osgSkin/Error>
#include <osgSkin/MorphTargets>
#include <osgSkin/UpdateMorphs>
#include <osgSkinMotion/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osgAnimation/Animation>
#include <osgAnimation/Bone>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace played;

using osgSkin::ClipPlayer;
using osgSkin::DeformableSkin;
using osgSkin::SampledClip;

/// Such as a head with a face.
TEST(ClipCharacter, CopiesMorphingRigidParts) {
    Character character(someClip(12, 0.8));
    const osg::ref_ptr<osgSkin::DeformableSkin> face =
        osg::clone(character.skin.get(), osg::CopyOp::SHALLOW_COPY);
    face->setUpdateCallback(nullptr);
    osgSkin::MorphTarget smile;
    smile.name = "smile";
    smile.vertices = {3};
    smile.positions = {glm::vec3(0.5f, 0.0f, 0.0f)};
    face->setMorphTargets(osgSkin::MorphTargets::create({smile}, face->getModel()->vertexCount()));
    character.rigid->addChild(face);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto first = copies->makeInstance(), second = copies->makeInstance();
    const auto faceOf = [](const osgSkin::ClipCharacter::Instance& instance) {
        osg::Group& rigid = *instance.node->getChild(1)->asGroup();
        return dynamic_cast<osgSkin::DeformableSkin*>(rigid.getChild(1));
    };
    ASSERT_NE(faceOf(first), nullptr);
    EXPECT_TRUE(faceOf(first)->setMorph("smile", 1.0f));
    EXPECT_EQ(faceOf(second)->getMorph("smile"), 0.0f);
    EXPECT_EQ(face->getMorph("smile"), 0.0f);

    const osg::ref_ptr<osgAnimation::Animation> talk =
        osg::clone(character.animation.get(), osg::CopyOp::DEEP_COPY_ALL);
    const osg::ref_ptr<osgAnimation::FloatLinearChannel> weight =
        new osgAnimation::FloatLinearChannel;
    weight->setTargetName(osgSkin::UpdateMorphs::kName);
    weight->setName("smile");
    weight->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(
        osgAnimation::FloatKeyframe(0.0, 1.0f));
    talk->addChannel(weight);
    const test::Notices notices;
    copies->sample(*talk, 30.0);
    EXPECT_TRUE(notices.say("moves morph targets")) << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

namespace {

/// A cull traversal that keeps what it would draw, and where.
struct Culled {
    std::vector<std::pair<const osg::Drawable*, osg::Matrixd>> drawn;
    double nearPlane = 0.0, farPlane = 0.0;

    Culled(osg::Node& scene, const osg::Matrixd& view) {
        const osg::ref_ptr<osgUtil::CullVisitor> cv = new osgUtil::CullVisitor;
        const osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        cv->setStateGraph(graph);
        cv->setRenderStage(stage);
        cv->pushViewport(new osg::Viewport(0, 0, 400, 400));
        cv->pushProjectionMatrix(new osg::RefMatrix(osg::Matrixd::perspective(40, 1, 0.1, 1e3)));
        cv->pushModelViewMatrix(new osg::RefMatrix(view), osg::Transform::ABSOLUTE_RF);
        scene.accept(*cv);
        nearPlane = cv->getCalculatedNearPlane();
        farPlane = cv->getCalculatedFarPlane();
        for (const osgUtil::StateGraph* states : stage->getStateGraphList())
            for (const auto& leaf : states->_leaves)
                drawn.emplace_back(leaf->getDrawable(), *leaf->_modelview);
        std::sort(drawn.begin(), drawn.end(),
                  [](const auto& a, const auto& b) { return a.first < b.first; });
    }
};

osg::ref_ptr<osg::Geometry> makeBox() {
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    for (unsigned int i = 0; i < 8; ++i)
        corners->push_back({i & 1u ? 0.5f : -0.5f, i & 2u ? 6.0f : 4.0f, i & 4u ? 0.5f : -0.5f});
    osg::ref_ptr<osg::Geometry> box = new osg::Geometry;
    box->setVertexArray(corners);
    box->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 8));
    return box;
}

} // namespace

/// The cull of a copy's rigid part passes over what other transforms do.
TEST(ClipCharacter, CullsRigidPartsLikeOtherTransforms) {
    Character character(someClip(12, 0.8));
    const osg::ref_ptr<osg::Geometry> first = makeBox(), second = makeBox();
    first->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    character.rigid->addChild(first);
    character.rigid->addChild(second);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto copy = copies->makeInstance(false);
    copy.player->setLayer(0, {SampledClip::create(someClip(12, 0.8), character.rig), 0.2});
    ASSERT_TRUE(copy.player->pose());
    auto& rigid = dynamic_cast<osg::MatrixTransform&>(*copy.node->getChild(1));
    copy.node->setMatrix(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(1, 2, 3));
    const osg::BoundingSphere& all = copy.node->getBound();
    const osg::Vec3d centre = all.center(), up(0, 0, 1);
    const osg::Vec3d at = rigid.getBound().center() * copy.node->getMatrix();
    const osg::ref_ptr<osg::NodeCallback> passes = new osg::NodeCallback;
    for (const osg::Vec3d& eye :
         {centre + osg::Vec3d(0, -60, 10), centre + osg::Vec3d(30, 20, 0), at}) {
        const osg::Matrixd view = osg::Matrixd::lookAt(eye, eye == at ? at + up : centre,
                                                       eye == at ? osg::Vec3d(0, 1, 0) : up);
        rigid.setCullCallback(nullptr);
        const Culled fast(*copy.node, view);
        rigid.setCullCallback(passes); // any callback: the part is then an ordinary transform
        const Culled slow(*copy.node, view);
        ASSERT_EQ(fast.drawn.size(), slow.drawn.size());
        for (std::size_t i = 0; i < fast.drawn.size(); ++i) {
            EXPECT_EQ(fast.drawn[i].first, slow.drawn[i].first);
            for (int k = 0; k < 16; ++k)
                EXPECT_NEAR(fast.drawn[i].second.ptr()[k], slow.drawn[i].second.ptr()[k], 1e-9);
        }
        EXPECT_LE(fast.nearPlane, slow.nearPlane + 1e-4);
        EXPECT_GE(fast.farPlane, slow.farPlane - 1e-4);
        EXPECT_LE(fast.farPlane, slow.farPlane + 2.0 * all.radius());
    }
    rigid.setCullCallback(nullptr);
    const osg::Matrixd seen = osg::Matrixd::lookAt(centre + osg::Vec3d(0, -60, 10), centre, up);
    const std::size_t drawn = Culled(*copy.node, seen).drawn.size();
    EXPECT_GE(drawn, 3u) << "the skin and both boxes";
    second->setNodeMask(0);
    EXPECT_EQ(Culled(*copy.node, seen).drawn.size(), drawn - 1);
    rigid.setNodeMask(0);
    EXPECT_EQ(Culled(*copy.node, seen).drawn.size(), 1u) << "the skin";
    const osg::Matrixd away =
        osg::Matrixd::lookAt(centre + osg::Vec3d(0, -60, 0), centre - osg::Vec3d(0, 120, 0), up);
    EXPECT_TRUE(Culled(*copy.node, away).drawn.empty());
}

TEST(ClipCharacter, CopiesObjectsAttachedToBones) {
    Character character(someClip(12, 0.8));
    const osg::ref_ptr<osg::Geometry> sword = makeBox();
    const osg::ref_ptr<osg::MatrixTransform> grip = new osg::MatrixTransform(
        osg::Matrixd::rotate(0.4, osg::Vec3d(1, 1, 0)) * osg::Matrixd::translate(0.5, 0.25, 1.0));
    grip->addChild(sword);
    character.rigid->getParent(0)->addChild(grip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto copy = copies->makeInstance(false);
    character.update(1.0 + 5.0 * kFrame);
    character.update(5.0 * kFrame);
    copy.player->setLayer(0, {copies->sample(*character.animation, 30.0), 5.0 * kFrame});
    ASSERT_TRUE(copy.player->pose());
    const auto placeOf = [&](osg::Node& node) {
        for (const auto& found : test::findNodes<osg::Node>(node))
            if (auto* at = dynamic_cast<osg::MatrixTransform*>(found.node))
                if (at->getNumChildren() == 1 && at->getChild(0) == sword.get())
                    return found.toWorld;
        return osg::Matrixd();
    };
    const osg::Matrixd expected = placeOf(*character.scene), is = placeOf(*copy.node);
    EXPECT_FALSE(expected.isIdentity());
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(is.ptr()[i], expected.ptr()[i], 1e-5) << i;
}

TEST(ClipCharacter, FindsRigidPartsInGroups) {
    Character character(someClip(12, 0.8));
    osg::Group& bone = *character.rigid->getParent(0);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(character.rigid);
    bone.replaceChild(character.rigid, group);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto copy = copies->makeInstance();
    copy.player->setLayer(0, {copies->sample(*copies->animations().front(), 30.0), 4.0 * kFrame});
    ASSERT_TRUE(copy.player->pose());
    character.update(1.0 + 4.0 * kFrame); // the manager starts at its first update
    character.update(4.0 * kFrame);
    osg::NodePath path = character.rigid->getParentalNodePaths(character.scene).front();
    const osg::Matrix expected = osg::computeLocalToWorld(path);
    const auto& rigid = dynamic_cast<osg::MatrixTransform&>(*copy.node->getChild(1));
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(rigid.getMatrix().ptr()[i], expected.ptr()[i], 1e-6) << i;
    // A transform that moves it away from its bone is not followed.
    const osg::ref_ptr<osg::MatrixTransform> aside =
        new osg::MatrixTransform(osg::Matrixd::translate(1, 0, 0));
    aside->addChild(character.rigid);
    bone.replaceChild(group, aside);
    EXPECT_THROW(osgSkin::ClipCharacter::create(*character.scene), osgSkin::Error);
}

TEST(ClipCharacter, BakedBoundsContainTheSkinBetweenSamples) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> at(-1.0, 3.0);
    for (const double speed : {0.3, 0.8, 2.6, 3.5}) { // the last ones rotate joints halfway around
        const auto clip = SampledClip::create(someClip(12, speed), character.rig);
        copies->bake(clip);
        const auto copy = copies->makeInstance();
        osgSkin::DeformableSkin& skin = skinOf(*copy.node);
        double mean = 0.0;
        constexpr int kTimes = 400;
        for (int i = 0; i < kTimes; ++i) {
            copy.player->setLayer(0, {clip, at(random) * clip->duration(), 1.0, i % 2 == 0});
            osg::BoundingBox tight;
            for (const osg::Vec3& p : posedBy(*copy.player, skin)) {
                ASSERT_TRUE(skin.getBoundingBox().contains(p)) << speed;
                tight.expandBy(p);
            }
            const osg::Vec3d is = skin.getBoundingBox()._max - skin.getBoundingBox()._min;
            const osg::Vec3d least = tight._max - tight._min;
            mean += is.x() * is.y() * is.z() / (least.x() * least.y() * least.z()) / kTimes;
        }
        if (speed < 1.0) {
            EXPECT_LE(mean, 1.2) << speed;
        }
    }
}

TEST(ClipCharacter, InstancesStartInTheRestPose) {
    Character character(someClip(12, 0.8));
    const Vertices rest = verticesOf(character.skin->getRestGeometry());
    character.update(0.1);
    character.update(0.3);
    ASSERT_GT(difference(verticesOf(*character.skin), rest), 0.1);
    const auto copy = osgSkin::ClipCharacter::create(*character.scene)->makeInstance();
    EXPECT_EQ(difference(verticesOf(skinOf(*copy.node)), rest), 0.0);
}

TEST(ClipCharacter, InstancesKeepStateAndNodeMasks) {
    Character character(someClip(12, 0.8));
    osg::Group& upright = *character.scene->getChild(0)->asGroup();
    upright.getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    character.rigid->getOrCreateStateSet()->setMode(GL_FOG, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    character.skeleton->addChild(choice);
    for (const bool on : {true, false}) {
        character.skin->getParent(0)->removeChild(character.skin);
        choice->addChild(character.skin, on);
        upright.setNodeMask(on ? 0x30u : 0x10u);
        const auto copy = osgSkin::ClipCharacter::create(*character.scene)->makeInstance();
        const osg::Node &skin = *copy.node->getChild(0), &rigid = *copy.node->getChild(1);
        for (const osg::Node* part : {&skin, &rigid}) {
            ASSERT_NE(part->getStateSet(), nullptr);
            EXPECT_EQ(part->getStateSet()->getMode(GL_BLEND), osg::StateAttribute::ON);
        }
        EXPECT_EQ(rigid.getStateSet()->getMode(GL_FOG), osg::StateAttribute::ON);
        EXPECT_EQ(skin.getNodeMask(), on ? 0x30u : 0u);
        EXPECT_EQ(rigid.getNodeMask(), on ? 0x30u : 0x10u);
    }
}

TEST(ClipCharacter, BoundsContainBlendsOfBakedClips) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto slow = SampledClip::create(someClip(12, 0.3), character.rig);
    const auto fast = SampledClip::create(someClip(9, 1.2), character.rig);
    copies->bake(slow);
    copies->bake(fast);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    const auto expectHeld = [&] {
        for (const osg::Vec3& p : posedBy(*copy.player, skin))
            ASSERT_TRUE(skin.getBoundingBox().contains(p, 1e-5f));
    };
    for (int i = 0; i < 60; ++i) {
        copy.player->setLayer(0, {slow, 0.013 * i});
        copy.player->setLayer(1, {fast, 0.017 * i});
        for (const double weight : {0.0, 0.4, 1.0}) {
            copy.player->setWeight(weight);
            expectHeld();
        }
        copy.player->setRoot(ClipPlayer::Root::InPlace);
        expectHeld();
        copy.player->setRoot(ClipPlayer::Root::Moving);
    }
}

TEST(ClipCharacter, FindsClipsByName) {
    Character character(someClip(12, 0.3));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = copies->clip("some");
    EXPECT_EQ(clip->name(), "some");
    EXPECT_EQ(copies->clip("some"), clip) << "sampled once";
    try {
        copies->clip("other");
        ADD_FAILURE() << "expected an error";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find("expected one of \"some\""), std::string::npos);
    }
}

/// Baked data are for the model that the character had then.
TEST(ClipCharacter, AcceptsAnotherModelAfterBaking) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip();
    character->bake(clip);
    const auto copy = character->makeInstance(false);
    auto& skin = dynamic_cast<DeformableSkin&>(*copy.node->getChild(0)->asGroup()->getChild(0));
    copy.player->setLayer(0, {clip});
    EXPECT_EQ(posedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
    skin.setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(posedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
}

TEST(ClipCharacter, BakesEverySkin) {
    const auto skeleton = test::makeBones();
    for (int i = 0; i < 2; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(100.0 * i, 0, 0));
        place->addChild(test::makeSkin());
        skeleton->addChild(place);
    }
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip();
    character->bake(clip);
    EXPECT_NEAR(character->bakedBounds().xMax(), 101.0f, 1.0f);
    EXPECT_NEAR(character->bakedBounds().xMin(), -1.0f, 1.0f);
    const auto copy = character->makeInstance(false);
    copy.player->setLayer(0, {clip});
    ASSERT_TRUE(copy.player->pose());
    std::size_t skins = 0;
    for (unsigned i = 0; i < copy.node->getNumChildren(); ++i) {
        const auto* skin =
            dynamic_cast<DeformableSkin*>(copy.node->getChild(i)->asGroup()->getChild(0));
        if (!skin) continue;
        ++skins;
        EXPECT_EQ(verticesOf(*skin), posedAfresh(skin->getModel(), clip)) << i;
        EXPECT_TRUE(skin->getBoundingBox().valid());
    }
    EXPECT_EQ(skins, 2u);
}

TEST(ClipCharacter, FailedBakeChangesNothing) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    osgSkin::Clip bad = bentMotion();
    bad.rotations.back().w = std::nan(""); // of the last sample
    EXPECT_THROW(character->bake(SampledClip::create(bad, tubeRig())), osgSkin::Error);
    EXPECT_FALSE(character->bakedBounds().valid());
    character->bake(bentClip());
    EXPECT_TRUE(character->bakedBounds().valid());
}
