// SPDX-License-Identifier: MIT
//
// Loads of one file share what does not change, without osgDB's object cache.
#include "SavedScene.h"
#include "TextFile.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/RigidPart>
#include <osgSkin/ShareEqualData>

#include <gtest/gtest.h>
#include <osgAnimation/Animation>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>

#include <thread>

namespace {

using osgAnimation::QuatSphericalLinearChannel;
using osgAnimation::Vec3LinearChannel;
using osgSkin::AutoPlayManager;

osg::ref_ptr<osgAnimation::Animation> makeClip() {
    osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->setName("a clip");
    const osg::ref_ptr<QuatSphericalLinearChannel> turns = new QuatSphericalLinearChannel;
    turns->setName("quaternion");
    turns->setTargetName("a bone with blanks");
    auto* keys = turns->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (int i = 0; i < 5; ++i)
        keys->push_back({0.1 * i, osg::Quat(0.3 * i, osg::Vec3d(0.6, 0.0, 0.8))});
    const osg::ref_ptr<Vec3LinearChannel> moves = new Vec3LinearChannel;
    moves->setName("position");
    moves->setTargetName("root");
    auto* places = moves->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (int i = 0; i < 3; ++i)
        places->push_back({0.7 * i, osg::Vec3(0.1f * float(i), 2.0f, 3.0f)});
    clip->addChannel(turns);
    clip->addChannel(moves);
    clip->setPlayMode(osgAnimation::Animation::PPONG);
    clip->setDuration(1.25);
    return clip;
}

osg::ref_ptr<osg::Group> sceneWith(const osgAnimation::AnimationList& clips) {
    osg::ref_ptr<osg::Group> scene = test::makeScene();
    const osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
    manager->registerAnimations(clips);
    manager->setAutomaticLink(false);
    scene->setUpdateCallback(manager);
    return scene;
}

const osgAnimation::AnimationList& clipsOf(osg::Node& scene) {
    return dynamic_cast<AutoPlayManager&>(*scene.getUpdateCallback()).getAnimationList();
}

template <typename Channel>
const auto& keysOf(const osgAnimation::Animation& clip, std::size_t channel) {
    return *dynamic_cast<const Channel&>(*clip.getChannels()[channel])
                .getSamplerTyped()
                ->getKeyframeContainerTyped();
}

class Shared : public testing::TestWithParam<const char*> {
protected:
    osg::ref_ptr<osg::Node> load(const std::string& file) const {
        return test::load(file, GetParam());
    }
};

} // namespace

TEST_P(Shared, LoadsOfOneFileShareModelArraysAndKeys) {
    const std::string file = test::save(*sceneWith({makeClip()}), GetParam());
    const osg::ref_ptr<osg::Node> first = load(file), second = load(file);
    const auto a = test::skinsOf(*first), b = test::skinsOf(*second);
    ASSERT_EQ(a.size(), 2u);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NE(a[i], b[i]);
        EXPECT_EQ(a[i]->getModel(), b[i]->getModel());
        const osg::Geometry &restA = *a[i]->getRestGeometry(), &restB = *b[i]->getRestGeometry();
        EXPECT_NE(&restA, &restB);
        EXPECT_EQ(restA.getVertexArray(), restB.getVertexArray());
        EXPECT_EQ(restA.getTexCoordArray(0), restB.getTexCoordArray(0));
        EXPECT_EQ(restA.getPrimitiveSet(0), restB.getPrimitiveSet(0));
        EXPECT_NE(a[i]->getStateSet(), b[i]->getStateSet());
        EXPECT_NE(a[i]->getDeformedGeometry()->getVertexArray(),
                  b[i]->getDeformedGeometry()->getVertexArray());
    }
    EXPECT_NE(clipsOf(*first)[0], clipsOf(*second)[0]);
    EXPECT_EQ(&keysOf<QuatSphericalLinearChannel>(*clipsOf(*first)[0], 0),
              &keysOf<QuatSphericalLinearChannel>(*clipsOf(*second)[0], 0));
}

TEST_P(Shared, ChangedFileHasItsOwnModel) {
    const std::string file = test::save(*test::makeScene(), GetParam());
    test::Tube changed;
    changed.positions[3].x += 0.25f;
    const std::string other = test::save(*test::makeScene(changed), GetParam());
    const osg::ref_ptr<osg::Node> first = load(file), second = load(other);
    const auto a = test::skinsOf(*first), b = test::skinsOf(*second);
    EXPECT_NE(a[0]->getModel(), b[0]->getModel());
    EXPECT_NE(a[0]->getModel()->positions(), b[0]->getModel()->positions());
    EXPECT_NE(a[0]->getRestGeometry()->getVertexArray(), b[0]->getRestGeometry()->getVertexArray());
}

TEST_P(Shared, ModelIsFreedWithItsScene) {
    const std::string file = test::save(*test::makeScene(), GetParam());
    osg::ref_ptr<osg::Node> scene = load(file);
    const osg::observer_ptr<osgSkin::SkinModel> model =
        const_cast<osgSkin::SkinModel*>(test::skinsOf(*scene)[0]->getModel());
    scene = nullptr;
    EXPECT_FALSE(model.valid());
}

TEST_P(Shared, ConcurrentLoadsShareTheModel) {
    const std::string file = test::save(*sceneWith({makeClip()}), GetParam());
    std::vector<osg::ref_ptr<osg::Node>> scenes(8);
    std::vector<std::thread> threads;
    for (auto& scene : scenes) threads.emplace_back([&] { scene = load(file); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& scene : scenes) {
        ASSERT_NE(scene, nullptr);
        EXPECT_EQ(test::skinsOf(*scene)[0]->getModel(), test::skinsOf(*scenes[0])[0]->getModel());
    }
}

TEST_P(Shared, ClipsRoundTrip) {
    const osg::ref_ptr<osgAnimation::Animation> was = makeClip();
    const osg::ref_ptr<osgAnimation::Animation> steps = new osgAnimation::Animation; // of no block
    steps->setName("steps");
    const osg::ref_ptr<osgAnimation::Vec3StepChannel> step = new osgAnimation::Vec3StepChannel;
    step->setName("position");
    step->setTargetName("root");
    step->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(
        {0.5, osg::Vec3(1.0f, 2.0f, 3.0f)});
    steps->addChannel(step);
    const osg::ref_ptr<osg::Node> scene =
        load(test::save(*sceneWith({was, steps, was}), GetParam()));
    ASSERT_NE(scene, nullptr);
    EXPECT_FALSE(dynamic_cast<AutoPlayManager&>(*scene->getUpdateCallback()).getAutomaticLink());
    const osgAnimation::AnimationList& clips = clipsOf(*scene);
    ASSERT_EQ(clips.size(), 3u);
    EXPECT_EQ(clips[1]->getName(), "steps");
    ASSERT_EQ(clips[1]->getChannels().size(), 1u);
    EXPECT_EQ(keysOf<osgAnimation::Vec3StepChannel>(*clips[1], 0)[0].getValue(),
              osg::Vec3(1.0f, 2.0f, 3.0f));
    for (const std::size_t clip : {0u, 2u}) {
        const osgAnimation::Animation& is = *clips[clip];
        EXPECT_EQ(is.getName(), "a clip");
        EXPECT_EQ(is.getDuration(), 1.25);
        EXPECT_EQ(is.getPlayMode(), osgAnimation::Animation::PPONG);
        ASSERT_EQ(is.getChannels().size(), 2u);
        EXPECT_EQ(is.getChannels()[0]->getTargetName(), "a bone with blanks");
        const auto& turnsWere = keysOf<QuatSphericalLinearChannel>(*was, 0);
        const auto& turns = keysOf<QuatSphericalLinearChannel>(is, 0);
        ASSERT_EQ(turns.size(), turnsWere.size());
        for (unsigned int i = 0; i < turns.size(); ++i) {
            EXPECT_EQ(turns[i].getTime(), turnsWere[i].getTime());
            EXPECT_EQ(turns[i].getValue(), turnsWere[i].getValue());
        }
        EXPECT_EQ(keysOf<Vec3LinearChannel>(is, 1)[2].getValue(),
                  keysOf<Vec3LinearChannel>(*was, 1)[2].getValue());
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, Shared, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });

TEST(ShareEqualData, EditsDoNotReachLaterLoads) {
    const std::string file = test::save(*sceneWith({makeClip()}), "osgb");
    const osg::ref_ptr<osg::Node> first = test::load(file, "osgb");
    auto& uv = static_cast<osg::Vec2Array&>(
        *const_cast<osg::Array*>(test::skinsOf(*first)[0]->getRestGeometry()->getTexCoordArray(0)));
    const osg::Vec2 was = uv[0];
    uv[0] = osg::Vec2(7.0f, 7.0f);
    auto& keys = const_cast<osgAnimation::QuatKeyframeContainer&>(
        keysOf<QuatSphericalLinearChannel>(*clipsOf(*first)[0], 0));
    keys[0].setValue(osg::Quat(0.0, 1.0, 0.0, 0.0));
    const osg::ref_ptr<osg::Node> second = test::load(file, "osgb");
    EXPECT_EQ(static_cast<const osg::Vec2Array&>(
                  *test::skinsOf(*second)[0]->getRestGeometry()->getTexCoordArray(0))[0],
              was);
    EXPECT_EQ(keysOf<QuatSphericalLinearChannel>(*clipsOf(*second)[0], 0)[0].getValue(),
              osg::Quat(0.0, 0.0, 0.0, 1.0));
}

TEST(ShareEqualData, RigidPartsShareTheirArrays) {
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("head");
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(3));
    geometry->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLES, 3));
    new osgSkin::RigidPart(geometry, *bone);
    const std::string file = test::save(*bone, "osgb");
    const auto load = [&] { return test::load(file, "osgb"); };
    const osg::ref_ptr<osg::Node> first = load(), second = load();
    const auto geometryOf = [](osg::Node& node) {
        return node.asGroup()->getChild(0)->asGroup()->getChild(0)->asGeometry();
    };
    EXPECT_NE(geometryOf(*first), geometryOf(*second));
    EXPECT_EQ(geometryOf(*first)->getVertexArray(), geometryOf(*second)->getVertexArray());
    EXPECT_EQ(geometryOf(*first)->getPrimitiveSet(0), geometryOf(*second)->getPrimitiveSet(0));
}

TEST(ShareEqualData, NamedModelsAreNotShared) {
    const test::Tube tube;
    const auto a = tube.model(), b = tube.model(), c = tube.model();
    const_cast<osgSkin::SkinModel&>(*c).setName("own");
    EXPECT_EQ(osgSkin::shareEqualModel(a), a);
    EXPECT_EQ(osgSkin::shareEqualModel(b), a);
    EXPECT_EQ(osgSkin::shareEqualModel(c), c);
}
