// SPDX-License-Identifier: MIT
// Clips played without bones, compared with the same clips on an osgAnimation skeleton.
#include "BentClip.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/ClipPlayer>

#include <gtest/gtest.h>
#include <osg/MatrixTransform>

#include <cmath>
#include <limits>

using namespace played;

using osgSkin::ClipPlayer;
using osgSkin::DeformableSkin;
using osgSkin::SampledClip;

namespace {

/// The same clip, and a rig for it, without the middle joint.
osgSkin::Clip withoutMiddle(osgSkin::Clip clip) {
    std::vector<glm::dquat> kept;
    for (std::size_t f = 0; f < clip.frames; ++f)
        for (const std::size_t j : {0u, 2u}) kept.push_back(clip.rotations[3 * f + j]);
    clip.joints = 2;
    clip.rotations = kept;
    return clip;
}

osgSkin::RestSkeleton sparseRig() {
    osgSkin::RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0, 0, 0));
    rig.add("end", 0, glm::dvec3(0, 4, 0));
    return rig;
}

} // namespace

TEST(ClipPlayer, MatchesTheSkeleton) {
    const osgSkin::Clip clip = someClip(12, 0.8);
    Character character(clip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    ASSERT_EQ(copies->animations().size(), 1u);
    const auto own = SampledClip::create(clip, character.rig);
    const auto sampled = copies->sample(*copies->animations().front(), 30.0);
    ASSERT_EQ(own->sampleCount(), 12u);
    for (const auto& played : {own, sampled}) {
        copies->bake(played);
        const auto copy = copies->makeInstance();
        osgSkin::DeformableSkin& skin = skinOf(*copy.node);
        for (std::size_t f = 1; f < played->sampleCount(); ++f) {
            character.update(1.0 + double(f) * kFrame); // the manager starts at its first update
            character.update(double(f) * kFrame);
            for (const bool interpolated : {true, false}) {
                copy.player->setInterpolated(interpolated);
                copy.player->setLayer(0, {played, double(f) * kFrame});
                const Vertices here = posedBy(*copy.player, skin);
                ASSERT_LE(difference(here, verticesOf(*character.skin)), 1e-6 * kSize) << f;
                for (const osg::Vec3& p : here)
                    ASSERT_TRUE(skin.getBoundingBox().contains(p, 1e-5f)) << interpolated;
            }
        }
        // The rigid part is at its bone's position.
        auto* rigid = dynamic_cast<osg::MatrixTransform*>(copy.node->getChild(1));
        ASSERT_TRUE(rigid);
        osg::NodePath path = character.rigid->getParentalNodePaths(character.scene).front();
        const osg::Matrix expected = osg::computeLocalToWorld(path);
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(rigid->getMatrix().ptr()[i], expected.ptr()[i], 1e-6) << i;
    }
}

TEST(ClipPlayer, PosesAddedSkins) {
    const osgSkin::Clip clip = someClip(12, 0.8);
    Character character(clip);
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(character.skin);
    EXPECT_FALSE(player->pose()); // no clip yet
    const auto played = SampledClip::create(clip, character.rig);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto copy = copies->makeInstance();
    for (int i = 0; i < 20; ++i) {
        player->setLayer(0, {played, 0.021 * i});
        copy.player->setLayer(0, {played, 0.021 * i});
        const Vertices expected = posedBy(*copy.player, skinOf(*copy.node));
        EXPECT_LE(difference(posedBy(*player, *character.skin), expected), 1e-6 * kSize);
    }
}

TEST(ClipPlayer, JointMissingFromTheClipFollowsItsParent) {
    osgSkin::Clip whole = someClip(12, 0.8);
    for (std::size_t f = 0; f < whole.frames; ++f)
        whole.rotations[3 * f + 1] = glm::dquat(1.0, 0.0, 0.0, 0.0); // the middle one does not move
    const osgSkin::Clip without = withoutMiddle(whole);
    const osgSkin::RestSkeleton sparse = sparseRig();
    const Character character(whole);
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(character.skin);
    for (int i = 1; i < 10; ++i) {
        player->setLayer(0, {SampledClip::create(whole, character.rig), 0.03 * i});
        const Vertices expected = posedBy(*player, *character.skin);
        player->setLayer(0, {SampledClip::create(without, sparse), 0.03 * i});
        EXPECT_LE(difference(posedBy(*player, *character.skin), expected), 1e-6 * kSize) << i;
    }
}

/// At both ends of a blend, whichever clip has fewer joints.
TEST(ClipPlayer, BlendsWithClipsOfFewerJoints) {
    const osgSkin::Clip whole = someClip(12, 0.8);
    const osgSkin::Clip without = withoutMiddle(whole);
    const osgSkin::RestSkeleton sparse = sparseRig();
    const Character character(whole);
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(character.skin);
    const ClipPlayer::Layer tracks[] = {{SampledClip::create(whole, character.rig), 0.21},
                                        {SampledClip::create(without, sparse), 0.13}};
    for (const std::size_t first : {0u, 1u}) {
        Vertices alone[2];
        for (const std::size_t t : {0u, 1u}) {
            player->setLayer(1, {});
            player->setLayer(0, tracks[t == 0 ? first : 1 - first]);
            alone[t] = posedBy(*player, *character.skin);
        }
        ASSERT_GT(difference(alone[0], alone[1]), 0.1);
        player->setLayer(0, tracks[first]);
        player->setLayer(1, tracks[1 - first]);
        for (const double weight : {0.0, 1e-4, 0.5, 1.0 - 1e-4, 1.0}) {
            player->setWeight(weight);
            const Vertices here = posedBy(*player, *character.skin);
            const bool isNext = weight > 0.5;
            if (weight == 0.5)
                EXPECT_GT(difference(here, alone[0]), 0.05);
            else
                EXPECT_LE(difference(here, alone[isNext]), weight == double(isNext) ? 0.0 : 0.01)
                    << first << ' ' << weight;
        }
    }
}

TEST(ClipPlayer, CopyPosesNothing) {
    const test::Notices notices;
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    const osg::ref_ptr<ClipPlayer> copy = osg::clone(player.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(notices.say("a copy of a ClipPlayer poses nothing")) << notices.text();
    EXPECT_STREQ(copy->className(), "ClipPlayer");
}

TEST(ClipPlayer, LoopsWithoutASeam) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(someClip(12, 0.8), character.rig);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    copy.player->setRoot(ClipPlayer::Root::InPlace);
    for (const double seam :
         {0.0, clip->duration(), -clip->duration(), clip->duration() - kFrame}) {
        copy.player->setLayer(0, {clip, seam - 1e-6});
        const Vertices before = posedBy(*copy.player, skin);
        copy.player->setLayer(0, {clip, seam + 1e-6});
        EXPECT_LE(difference(posedBy(*copy.player, skin), before), 1e-3);
        EXPECT_GT(difference(verticesOf(skin), verticesOf(skin.getRestGeometry())), 0.1);
    }
}

TEST(ClipPlayer, PlaysForwardsBackwardsAndPauses) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(someClip(12, 0.8), character.rig);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    copy.player->setLayer(0, {clip, 3.0 * kFrame});
    const Vertices third = posedBy(*copy.player, skin);
    copy.player->setLayer(0, {clip, 5.0 * kFrame, -2.0});
    copy.player->advance(kFrame);
    EXPECT_LE(difference(posedBy(*copy.player, skin), third), 1e-6);
    copy.player->setLayer(0, {clip, 3.0 * kFrame, 0.0});
    copy.player->advance(17.0);
    EXPECT_LE(difference(posedBy(*copy.player, skin), third), 1e-6);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    copy.player->advance(nan);
    EXPECT_LE(difference(posedBy(*copy.player, skin), third), 1e-6);
    copy.player->setLayer(0, {clip, nan, nan});
    EXPECT_EQ(copy.player->getLayer(0).time, 0.0);
    EXPECT_EQ(copy.player->getLayer(0).speed, 0.0);
    EXPECT_TRUE(copy.player->pose());
    copy.player->setLayer(0, {});
    EXPECT_FALSE(copy.player->pose());
}

TEST(ClipPlayer, BlendsExactlyAtBothEnds) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto first = SampledClip::create(someClip(12, 0.8), character.rig);
    const auto second = SampledClip::create(someClip(7, -0.5), character.rig);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    copy.player->setLayer(0, {second, 0.1});
    const Vertices b = posedBy(*copy.player, skin);
    copy.player->setLayer(0, {first, 0.1});
    const Vertices a = posedBy(*copy.player, skin);
    ASSERT_GT(difference(a, b), 0.1);
    copy.player->setLayer(1, {second, 0.1});
    copy.player->setWeight(0.0);
    EXPECT_EQ(difference(posedBy(*copy.player, skin), a), 0.0);
    copy.player->setWeight(1.0);
    EXPECT_EQ(difference(posedBy(*copy.player, skin), b), 0.0);
    copy.player->setWeight(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(copy.player->getWeight(), 1.0);
    copy.player->setWeight(0.5);
    const Vertices half = posedBy(*copy.player, skin);
    EXPECT_GT(difference(half, a), 0.01);
    EXPECT_GT(difference(half, b), 0.01);
    EXPECT_LT(difference(half, a), difference(a, b));
}

TEST(ClipPlayer, ExtractsRootMotion) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(someClip(12, 1.0), character.rig);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    const auto middle = [&] { return skin.getBoundingBox().center().x(); };
    copy.player->setLayer(0, {clip, 0.0});
    copy.player->pose();
    const float start = middle();
    copy.player->setLayer(0, {clip, 11.0 * kFrame});
    copy.player->pose();
    EXPECT_NEAR(middle() - start, 1.1, 0.6); // its rotations move its middle, too
    // 0.1 per frame, also across the seam; steps up and down stay in the pose.
    copy.player->setRoot(ClipPlayer::Root::Extracted);
    copy.player->setLayer(0, {clip, 0.0});
    for (int i = 0; i < 36; ++i) {
        copy.player->advance(kFrame);
        const osg::Vec3d way = copy.player->takeRootMotion();
        EXPECT_NEAR(way.x(), 0.1, 1e-6) << i;
        EXPECT_NEAR(way.y(), 0.0, 1e-9);
    }
    copy.player->pose();
    EXPECT_NEAR(middle() - start, 0.0, 0.01);
    copy.player->advance(-25.0 * kFrame);
    EXPECT_NEAR(copy.player->takeRootMotion().x(), -2.5, 1e-6);
    EXPECT_EQ(copy.player->takeRootMotion().x(), 0.0);
}

/// Files of cycles often end with the frame with which they begin.
TEST(ClipPlayer, RootStandsWhereACycleRepeatsItsFirstPose) {
    osgSkin::Clip cycle = someClip(12, 1.0);
    for (std::size_t j = 0; j < 3; ++j) cycle.rotations[3 * 11 + j] = cycle.rotations[j];
    Character character(someClip(12, 0.0));
    const auto copy = osgSkin::ClipCharacter::create(*character.scene)->makeInstance();
    copy.player->setLayer(0, {SampledClip::create(cycle, character.rig), 0.0});
    for (const ClipPlayer::Root root :
         {ClipPlayer::Root::Extracted, ClipPlayer::Root::ExtractedWithTurn}) {
        copy.player->setRoot(root);
        copy.player->seek(0, 0.0);
        for (int i = 0; i < 24; ++i) {
            copy.player->advance(kFrame);
            EXPECT_NEAR(copy.player->takeRootMatrix().getTrans().x(), i % 12 == 11 ? 0.0 : 0.1,
                        1e-6)
                << i;
        }
    }
}

namespace {

/// A walk along an arc of a circle of radius 3, swaying; `up` is y.
osgSkin::Clip walkOnAnArc(std::size_t frames, double angle) {
    osgSkin::Clip clip = someClip(frames, 0.3);
    for (std::size_t f = 0; f < frames; ++f) {
        const glm::dquat turn =
            glm::angleAxis(angle * double(f) / double(frames), glm::dvec3(0, 1, 0));
        clip.rotations[3 * f] = turn * clip.rotations[3 * f];
        clip.rootPositions[f] =
            turn * glm::dvec3(3.0, 0.0, 0.0) + glm::dvec3(1.0, clip.rootPositions[f].y, -2.0);
    }
    return clip;
}

/// A copy's vertices in the space of its node's parent.
Vertices placedBy(const osgSkin::ClipCharacter::Instance& copy, const osg::Matrixd& toWorld) {
    Vertices vertices = posedBy(*copy.player, skinOf(*copy.node));
    for (osg::Vec3& v : vertices) v = v * (toWorld * copy.node->getMatrix());
    return vertices;
}

} // namespace

TEST(ClipPlayer, RootMotionReplacesTheWalk) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(walkOnAnArc(24, 5.0), character.rig);
    for (const auto root : {ClipPlayer::Root::Extracted, ClipPlayer::Root::ExtractedWithTurn}) {
        const auto mover = copies->makeInstance(false), walker = copies->makeInstance(false);
        mover.player->setLayer(0, {clip});
        walker.player->setLayer(0, {clip});
        walker.player->setRoot(root);
        for (const double step : {0.02, 0.05, 0.2, 0.111, 0.3, -0.4}) { // all in the first loop
            mover.player->advance(step);
            walker.player->advance(step);
            walker.node->preMult(walker.player->takeRootMatrix());
            const Vertices moved = placedBy(mover, copies->toWorld());
            EXPECT_LE(difference(placedBy(walker, copies->toWorld()), moved), 2e-6 * kSize);
        }
        EXPECT_GT(walker.node->getMatrix().getTrans().length(), 0.5);
    }
}

TEST(ClipPlayer, RootMotionTurnsAcrossLoops) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    // A third of the circle: the walker is back after three loops, whatever the steps.
    const auto clip = SampledClip::create(walkOnAnArc(24, 2.0 * osg::PI / 3.0), character.rig);
    for (const double step : {0.25 * kFrame, kFrame, 7.3 * kFrame, 72.0 * kFrame, -kFrame}) {
        const auto copy = copies->makeInstance(false);
        copy.player->setLayer(0, {clip});
        copy.player->setRoot(ClipPlayer::Root::ExtractedWithTurn);
        osg::Matrixd way;
        const double whole = 72.0 * kFrame * (step < 0.0 ? -1.0 : 1.0);
        const auto steps = static_cast<int>(whole / step + 1e-6);
        const auto advance = [&](double seconds) {
            copy.player->advance(seconds);
            const osg::Matrixd next = copy.player->takeRootMatrix();
            if (std::abs(seconds) < 2.0 * kFrame) {
                EXPECT_LT(osg::Vec3d(next.getTrans() - osg::Vec3d(4, 0, -2) +
                                     osg::Matrixd::transform3x3(osg::Vec3d(4, 0, -2), next))
                              .length(),
                          0.6);
            }
            way.preMult(next);
        };
        for (int i = 0; i < steps; ++i) advance(step);
        advance(whole - steps * step);
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(way.ptr()[i], osg::Matrixd().ptr()[i], 1e-6) << step << ' ' << i;
    }
}

TEST(ClipPlayer, RootMotionBlendsTheTurnsOfTwoClips) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto straight = SampledClip::create(walkOnAnArc(24, 0.0), character.rig);
    const auto arc = SampledClip::create(walkOnAnArc(24, 1.2), character.rig);
    const auto copy = copies->makeInstance(false);
    copy.player->setRoot(ClipPlayer::Root::ExtractedWithTurn);
    copy.player->setLayer(0, {straight});
    copy.player->setLayer(1, {arc});
    for (const double weight : {0.0, 0.25, 1.0}) {
        copy.player->setWeight(weight);
        osg::Matrixd way;
        for (int i = 0; i < 24; ++i) {
            copy.player->advance(kFrame);
            way.preMult(copy.player->takeRootMatrix());
        }
        const osg::Matrixd atRest =
            copies->toWorld() * way * osg::Matrixd::inverse(copies->toWorld());
        EXPECT_NEAR(std::atan2(atRest(2, 0), atRest(0, 0)), 1.2 * weight, 0.01) << weight;
    }
    copy.player->advance(kFrame);
    EXPECT_EQ(copy.player->takeRootMotion(), osg::Vec3d()) << "it is no Extracted one";
    EXPECT_TRUE(copy.player->takeRootMatrix().isIdentity());
}

TEST(ClipPlayer, AdvancesAsAnUpdateCallback) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(someClip(12, 0.8), character.rig);
    const auto copy = copies->makeInstance();
    copy.player->setLayer(0, {clip, 0.0, 2.0});
    for (const double time : {100.0, 100.1}) test::updateAt(*copy.node, time);
    EXPECT_NEAR(copy.player->getLayer(0).time, 0.2, 1e-9);
    EXPECT_EQ(skinOf(*copy.node).getDeformCount(), 0u); // it has not been in view yet
}

/// Memory is reused: a new clip may have the address of an old one.
TEST(ClipPlayer, DetectsANewClipAtAnOldAddress) {
    const auto skin = test::makeSkin();
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    osg::ref_ptr<const SampledClip> clip = bentClip();
    player->setLayer(0, {clip});
    const Vertices before = posedBy(*player, *skin);
    const void* const place = clip.get();
    player->setLayer(0, {});
    EXPECT_FALSE(player->pose()); // nothing plays
    clip = nullptr;
    std::vector<osg::ref_ptr<const SampledClip>> others;
    do others.push_back(bentClip(true));
    while (others.back() != place && others.size() < 3000);
    player->setLayer(0, {others.back()});
    EXPECT_EQ(posedBy(*player, *skin), posedAfresh(skin->getModel(), others.back()));
    EXPECT_NE(posedBy(*player, *skin), before);
    RecordProperty("clipsUntilThen", static_cast<int>(others.size()));
}

TEST(ClipPlayer, AcceptsAModelThatIsSetLater) {
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {bentClip()});
    EXPECT_FALSE(player->pose());
    skin->setSkin(test::makeGeometry(test::Tube()), test::Tube().model());
    EXPECT_EQ(posedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip()));
    skin->setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(posedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip()));
}

TEST(ClipPlayer, IgnoresNullSkinsAndParts) {
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(nullptr);
    player->addRigid(nullptr, "root", osg::Matrixd());
    player->setLayer(0, {bentClip()});
    EXPECT_TRUE(player->pose());
}
