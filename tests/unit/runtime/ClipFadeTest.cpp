// SPDX-License-Identifier: MIT
// Clips that fade into each other, clips on a part of the body, and characters that keep their
// bones.
#include "BentClip.h"
#include "UpdateAt.h"

#include <osgSkin/Error>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/RotateBone>

#include <gtest/gtest.h>

using namespace played;

using osgSkin::ClipPlayer;
using osgSkin::SampledClip;
using Clip = osg::ref_ptr<const SampledClip>;

namespace {

/// A player with a skin of its own.
struct Played {
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<ClipPlayer> player = new ClipPlayer;

    Played() { player->addSkin(skin); }
    Vertices after(double seconds) {
        player->advance(seconds);
        return posedBy(*player, *skin);
    }
};

Clip makeClip(double speed) {
    return SampledClip::create(someClip(12, speed), tubeRig());
}

/// The pose of two layers.
Vertices mixOf(const ClipPlayer::Layer& a, const ClipPlayer::Layer& b, double weight) {
    Played mix;
    mix.player->setLayer(0, a);
    mix.player->setLayer(1, b);
    mix.player->setWeight(weight);
    return mix.after(0.0);
}

} // namespace

TEST(ClipFade, GoesFromOneClipToTheNext) {
    const Clip walk = makeClip(0.3), run = makeClip(0.8);
    Played played;
    played.player->play({walk});
    played.after(0.1);
    played.player->play({run, 0.05}, 0.4);
    EXPECT_LE(difference(played.after(0.0), mixOf({walk, 0.1}, {}, 0.0)), 1e-6 * kSize);
    EXPECT_LE(difference(played.after(0.1), mixOf({walk, 0.2}, {run, 0.15}, 0.25)), 1e-6 * kSize);
    EXPECT_LE(difference(played.after(0.2), mixOf({walk, 0.4}, {run, 0.35}, 0.75)), 1e-6 * kSize);
    EXPECT_LE(difference(played.after(0.2), mixOf({run, 0.55}, {}, 0.0)), 1e-6 * kSize);
    EXPECT_FALSE(played.player->getLayer(1).clip);
}

TEST(ClipFade, BeginsAtOnceWithoutAFadeOrAClipBefore) {
    const Clip walk = makeClip(0.3), run = makeClip(0.8);
    Played played;
    played.player->play({walk, 0.1}, 5.0);
    EXPECT_LE(difference(played.after(0.0), mixOf({walk, 0.1}, {}, 0.0)), 1e-6 * kSize);
    played.player->play({run, 0.2}, 0.0);
    EXPECT_LE(difference(played.after(0.0), mixOf({run, 0.2}, {}, 0.0)), 1e-6 * kSize);
    played.player->play({}); // no clip: nothing changes
    EXPECT_EQ(played.player->getLayer(0).clip, run);
}

TEST(ClipFade, DoesNotJumpWhenAnotherFadeBegins) {
    const Clip walk = makeClip(0.3), run = makeClip(0.8), other = makeClip(-0.6);
    Played played;
    played.player->play({walk});
    played.player->play({run}, 0.4);
    const Vertices before = played.after(0.2);
    played.player->play({other, 0.1}, 0.4);
    EXPECT_LE(difference(played.after(0.0), before), 1e-6 * kSize);
    EXPECT_LE(difference(played.after(0.4), mixOf({other, 0.5}, {}, 0.0)), 1e-6 * kSize);
}

TEST(ClipOnPart, MovesTheJointsBelowAlone) {
    const osgSkin::Clip walk = someClip(12, 0.3), wave = someClip(12, 0.9);
    osgSkin::Clip both = walk;
    for (std::size_t f = 0; f < both.frames; ++f)
        for (const std::size_t j : {1u, 2u}) both.rotations[3 * f + j] = wave.rotations[3 * f + j];
    const auto clipOf = [](const osgSkin::Clip& clip) {
        return SampledClip::create(clip, tubeRig());
    };
    Played played;
    played.player->play({clipOf(walk)});
    EXPECT_THROW(played.player->playOn("tail", {clipOf(wave)}), osgSkin::Error);
    EXPECT_TRUE(played.player->playOn("middle", {clipOf(wave)}, 0.2));
    EXPECT_LE(difference(played.after(0.0), mixOf({clipOf(walk)}, {}, 0.0)), 1e-6 * kSize);
    // Joints alone are blended: the same as a blend of both clips below the joint.
    EXPECT_LE(difference(played.after(0.1), mixOf({clipOf(walk), 0.1}, {clipOf(both), 0.1}, 0.5)),
              1e-6 * kSize);
    EXPECT_LE(difference(played.after(0.1), mixOf({clipOf(both), 0.2}, {}, 0.0)), 1e-6 * kSize);
    played.player->stopOn(0.1);
    EXPECT_LE(difference(played.after(0.1), mixOf({clipOf(walk), 0.3}, {}, 0.0)), 1e-6 * kSize);
    // Without a fade at once.
    EXPECT_TRUE(played.player->playOn("middle", {clipOf(wave), 0.3}, 0.0));
    EXPECT_LE(difference(played.after(0.0), mixOf({clipOf(both), 0.3}, {}, 0.0)), 1e-6 * kSize);
    played.player->stopOn(0.0);
    EXPECT_LE(difference(played.after(0.0), mixOf({clipOf(walk), 0.3}, {}, 0.0)), 1e-6 * kSize);
}

TEST(BonePlayer, MovesBonesAndSkinAsTheManagerDid) {
    const osgSkin::Clip clip = someClip(12, 0.8);
    Character expected(clip), character(clip);
    const osg::ref_ptr<ClipPlayer> player = osgSkin::attach<ClipPlayer>(*character.scene);
    player->play({SampledClip::create(clip, character.rig)});
    for (const double time : {0.0, 2.0 * kFrame, 7.0 * kFrame}) {
        expected.update(time);
        character.update(time);
        for (const char* name : {"root", "middle", "end"}) {
            const auto* own = Character::findBone(*character.skeleton, name);
            const auto* other = Character::findBone(*expected.skeleton, name);
            for (int i = 0; i < 16; ++i) {
                EXPECT_NEAR(own->getMatrixInSkeletonSpace().ptr()[i],
                            other->getMatrixInSkeletonSpace().ptr()[i], 1e-5)
                    << name;
                EXPECT_NEAR(own->getMatrix().ptr()[i], other->getMatrix().ptr()[i], 1e-5) << name;
            }
        }
        EXPECT_LE(difference(verticesOf(*character.skin), verticesOf(*expected.skin)),
                  1e-5 * kSize);
    }
}

TEST(BonePlayer, LeavesBonesToTheirOwnCallbacksAfterwards) {
    struct Bend : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv);
            osgSkin::rotateBone(static_cast<osgAnimation::Bone&>(*node),
                                osg::Quat(0.5, osg::Vec3d(0, 0, 1)));
        }
    };
    const osgSkin::Clip clip = someClip(12, 0.8);
    Character plain(clip), character(clip);
    for (Character* each : {&plain, &character})
        osgSkin::attach<ClipPlayer>(*each->scene)->play({SampledClip::create(clip, each->rig)});
    osgAnimation::Bone* middle = Character::findBone(*character.skeleton, "middle");
    middle->addUpdateCallback(new Bend);
    for (const double time : {0.0, 0.1}) {
        plain.update(time);
        character.update(time);
    }
    const osg::Matrixd without =
        Character::findBone(*plain.skeleton, "middle")->getMatrixInSkeletonSpace();
    const osg::Quat turn =
        without.getRotate().inverse() * middle->getMatrixInSkeletonSpace().getRotate();
    double angle = 0.0;
    osg::Vec3d axis;
    turn.getRotate(angle, axis);
    EXPECT_NEAR(angle, 0.5, 1e-5);
}

TEST(BonePlayer, ExtractsRootMotion) {
    const osgSkin::Clip clip = someClip(12, 0.8);
    Character character(clip);
    const osg::ref_ptr<ClipPlayer> player = osgSkin::attach<osgSkin::ClipPlayer>(*character.scene);
    player->setRoot(ClipPlayer::Root::Extracted, osg::Vec3d(0, 1, 0));
    player->play({SampledClip::create(clip, character.rig)});
    const auto rootAt = [&](double time) {
        character.update(time);
        return Character::findBone(*character.skeleton, "root")->getMatrix().getTrans().x();
    };
    const double start = rootAt(0.0);
    EXPECT_NEAR(rootAt(6.0 * kFrame), start, 1e-6);
    EXPECT_NEAR(player->takeRootMotion().x(), 6.0 * 0.08, 1e-6);
}
