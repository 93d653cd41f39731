// SPDX-License-Identifier: MIT
#include <osgSkin/AutoPlayManager>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/LinkVisitor>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/Target>
#include <osgAnimation/UpdateBone>
#include <osgAnimation/UpdateMaterial>

#include <string>

namespace {

/// A constant channel of three numbers.
osgAnimation::Vec3LinearChannel* channelOf(const std::string& target, const std::string& name) {
    auto* channel = new osgAnimation::Vec3LinearChannel;
    channel->setTargetName(target);
    channel->setName(name);
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::Vec3Keyframe(0.0, osg::Vec3(1, 2, 3)));
    return channel;
}

/// A named callback with its own position.
template <class Update>
Update* callbackOf(const std::string& name) {
    auto* update = new Update;
    update->setName(name);
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedTranslateElement("translate", osg::Vec3()));
    return update;
}

/// Links like other callbacks, and records that it did.
class OwnUpdate : public osgAnimation::UpdateMatrixTransform {
public:
    int asked = 0;
    int link(osgAnimation::Animation* animation) override {
        ++asked;
        return osgAnimation::AnimationUpdateCallback<osg::NodeCallback>::link(animation);
    }
    bool link(osgAnimation::Channel* channel) override {
        return osgAnimation::UpdateMatrixTransform::link(channel);
    }
};

/// Two clips that animate everything below, and targets elsewhere.
osgAnimation::AnimationList clips() {
    osgAnimation::AnimationList result = {new osgAnimation::Animation, new osgAnimation::Animation};
    for (const auto& clip : result)
        for (const char* name : {"a", "b", "c", "elsewhere"})
            clip->addChannel(channelOf(name, "translate"));
    auto* colour = new osgAnimation::Vec4LinearChannel;
    colour->setTargetName("look");
    colour->setName("diffuse");
    colour->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(
        osgAnimation::Vec4Keyframe(0.0, osg::Vec4(1, 0, 0, 1)));
    result.back()->addChannel(colour);
    return result;
}

} // namespace

TEST(AutoPlayManager, LinksTheSameTargetsAsOsg) {
    const osg::ref_ptr<osgAnimation::UpdateBone> bone = callbackOf<osgAnimation::UpdateBone>("a");
    const osg::ref_ptr<osgAnimation::UpdateMatrixTransform>
        nested = callbackOf<osgAnimation::UpdateMatrixTransform>("b"),
        unmoved = callbackOf<osgAnimation::UpdateMatrixTransform>("nobody");
    const osg::ref_ptr<OwnUpdate> own = callbackOf<OwnUpdate>("c");
    unmoved->setNestedCallback(own);
    nested->setNestedCallback(unmoved);
    bone->setNestedCallback(nested);
    const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
    node->setUpdateCallback(bone);
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setUpdateCallback(new osgAnimation::UpdateMaterial("look"));
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->getOrCreateStateSet()->setAttribute(material);
    const osg::ref_ptr<osg::Geode> leaf = new osg::Geode;
    leaf->addDrawable(geometry);
    node->addChild(leaf);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);

    const osgAnimation::AnimationList theirs = clips(), ours = clips();
    osgAnimation::LinkVisitor visitor;
    visitor.getAnimationList() = theirs;
    root->accept(visitor);
    EXPECT_EQ(own->asked, 2);
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    manager->registerAnimations(ours);
    ASSERT_TRUE(manager->needToLink());
    manager->link(root);
    EXPECT_FALSE(manager->needToLink());
    EXPECT_EQ(own->asked, 4);
    for (std::size_t clip = 0; clip < ours.size(); ++clip)
        for (std::size_t i = 0; i < ours[clip]->getChannels().size(); ++i) {
            const std::string& name = ours[clip]->getChannels()[i]->getTargetName();
            EXPECT_EQ(ours[clip]->getChannels()[i]->getTarget() ==
                          theirs[clip]->getChannels()[i]->getTarget(),
                      name != "elsewhere")
                << clip << " " << name;
        }
}

TEST(AutoPlayManager, PlaysTheFirstClipUnlessAnotherPlays) {
    const osgAnimation::AnimationList some = clips();
    some[0]->setName("first");
    some[1]->setName("second");
    for (const bool chosen : {false, true}) {
        const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
        manager->registerAnimations(some);
        if (chosen) manager->playAnimation(some[1]);
        manager->update(0.0);
        EXPECT_EQ(manager->isPlaying("first"), !chosen);
        EXPECT_EQ(manager->isPlaying("second"), chosen);
        manager->stopAll();
        manager->update(1.0); // starts by itself once
        EXPECT_FALSE(manager->isPlaying("first"));
    }
}

TEST(AutoPlayManager, PlaysClipsOfOneKeyInEveryMode) {
    using osgAnimation::Animation;
    for (const Animation::PlayMode mode :
         {Animation::ONCE, Animation::STAY, Animation::LOOP, Animation::PPONG}) {
        const osg::ref_ptr<Animation> pose = clips().front();
        pose->setPlayMode(mode);
        const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
        manager->registerAnimation(pose);
        for (const double time : {5.0, 5.5, 9.0}) manager->update(time);
        auto* target =
            dynamic_cast<osgAnimation::Vec3Target*>(pose->getChannels().front()->getTarget());
        ASSERT_NE(target, nullptr);
        EXPECT_EQ(target->getValue(), osg::Vec3(1, 2, 3)) << mode;
    }
}

/// A manager that is added late plays from the start, and a clip that plays once plays completely.
TEST(AutoPlayManager, StartsAtItsFirstUpdate) {
    const osgAnimation::AnimationList some = clips();
    some[0]->setName("first");
    some[0]->setPlayMode(osgAnimation::Animation::ONCE);
    dynamic_cast<osgAnimation::Vec3LinearChannel&>(*some[0]->getChannels().front())
        .getOrCreateSampler()
        ->getOrCreateKeyframeContainer()
        ->push_back(osgAnimation::Vec3Keyframe(2.0, osg::Vec3()));
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    manager->registerAnimations(some);
    manager->update(100.0);
    EXPECT_TRUE(manager->isPlaying("first"));
    manager->update(101.0);
    EXPECT_TRUE(manager->isPlaying("first"));
    manager->update(102.5);
    EXPECT_FALSE(manager->isPlaying("first"));
}

/// A channel moves one target: a rider's bone would take it from the horse's of the same name.
TEST(AutoPlayManager, IgnoresANestedCharacterWithItsOwnManager) {
    const auto boneOf = [] {
        const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("a");
        bone->setUpdateCallback(callbackOf<osgAnimation::UpdateBone>("a"));
        return bone;
    };
    const auto targetOf = [](osgAnimation::Bone& bone) {
        auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*bone.getUpdateCallback());
        return update.getStackedTransforms().front()->getOrCreateTarget();
    };
    const osg::ref_ptr<osgAnimation::Skeleton> horse = new osgAnimation::Skeleton;
    const osg::ref_ptr<osgAnimation::Bone> back = boneOf(), hips = boneOf();
    const osg::ref_ptr<osg::Group> rider = new osg::Group;
    horse->addChild(back);
    back->addChild(rider);
    rider->addChild(hips);
    for (const bool managed : {false, true}) {
        if (managed) rider->setUpdateCallback(new osgSkin::AutoPlayManager);
        const osgAnimation::AnimationList ours = clips();
        const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
        manager->registerAnimations(ours);
        manager->link(horse);
        EXPECT_EQ(ours[0]->getChannels()[0]->getTarget(), targetOf(managed ? *back : *hips));
    }
}

/// An application's own visitor does the linking, as with OSG's managers.
/// A character may have a hundred clips, of which each copy plays one.
TEST(AutoPlayManager, CopiesShareChannelsUntilTheyPlay) {
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    osgAnimation::AnimationList originals = clips();
    originals.back()->getChannels().pop_back(); // of a kind that is copied at once
    manager->registerAnimations(originals);
    const auto sceneOf = [](osgSkin::AutoPlayManager& own) {
        osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform;
        scene->setUpdateCallback(callbackOf<osgAnimation::UpdateMatrixTransform>("a"));
        own.link(scene);
        own.update(0.0);
        return scene;
    };
    const auto scene = sceneOf(*manager);
    const osg::ref_ptr<osgSkin::AutoPlayManager> copy =
        osg::clone(manager.get(), osg::CopyOp::DEEP_COPY_ALL);
    ASSERT_EQ(copy->getAnimationList().size(), 2u);
    const auto channelOfCopy = [&](std::size_t clip) {
        return copy->getAnimationList()[clip]->getChannels()[0].get();
    };
    for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_NE(copy->getAnimationList()[c], originals[c]);
        EXPECT_EQ(channelOfCopy(c), originals[c]->getChannels()[0]);
        EXPECT_EQ(copy->getAnimationList()[c]->getDuration(), originals[c]->getDuration());
    }
    const osgAnimation::Target* const target = originals[0]->getChannels()[0]->getTarget();
    const auto another = sceneOf(*copy);
    EXPECT_NE(channelOfCopy(0), originals[0]->getChannels()[0]) << "it plays";
    EXPECT_EQ(channelOfCopy(1), originals[1]->getChannels()[0]);
    EXPECT_EQ(originals[0]->getChannels()[0]->getTarget(), target);
    const auto keysOf = [](osgAnimation::Channel& channel) {
        return dynamic_cast<osgAnimation::Vec3LinearChannel&>(channel)
            .getSamplerTyped()
            ->getKeyframeContainerTyped();
    };
    EXPECT_EQ(keysOf(*channelOfCopy(0)), keysOf(*originals[0]->getChannels()[0]));
    const auto& moved =
        dynamic_cast<osgAnimation::UpdateMatrixTransform&>(*another->getUpdateCallback());
    EXPECT_EQ(moved.getStackedTransforms()[0]->getTarget(), channelOfCopy(0)->getTarget());
    copy->playAnimation(copy->getAnimationList()[1]);
    copy->update(0.1);
    EXPECT_NE(channelOfCopy(1), originals[1]->getChannels()[0]);
}

TEST(AutoPlayManager, UsesTheApplicationsLinkVisitor) {
    const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
    node->setUpdateCallback(callbackOf<osgAnimation::UpdateMatrixTransform>("a"));
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    const osg::ref_ptr<osgAnimation::LinkVisitor> visitor = new osgAnimation::LinkVisitor;
    manager->setLinkVisitor(visitor);
    const unsigned int before = visitor->getNbLinkedTarget();
    manager->registerAnimations(clips());
    manager->link(node);
    EXPECT_GT(visitor->getNbLinkedTarget(), before);
}
