// SPDX-License-Identifier: MIT
//
// Clips played without bones, compared with the same clips on an osgAnimation skeleton.
//
// The inputs of a clip player may change, or be missing.
#include "Notices.h"
#include "PlayedFigure.h"
#include "TubeSkin.h"
#include "Turns.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinRig/ClipCharacter>
#include <osgSkinRig/ClipPlayer>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/MatrixTransform>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

using namespace played;

using osgSkin::ClipPlayer;
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

TEST(SampledClip, PlacesTimes) {
    const auto clip = SampledClip::create(someClip(10, 0.3), tubeRig());
    ASSERT_EQ(clip->sampleCount(), 10u);
    EXPECT_NEAR(clip->duration(), 10.0 * kFrame, 1e-12);
    const auto expectPlace = [&](double time, bool loop, std::size_t from, std::size_t to,
                                 double share) {
        SCOPED_TRACE(time);
        const SampledClip::Place place = clip->place(time, loop);
        EXPECT_EQ(place.from, from);
        EXPECT_EQ(place.to, to);
        EXPECT_NEAR(place.share, share, 1e-6);
    };
    for (std::size_t i = 0; i < 10; ++i)
        for (const double loops : {-3.0, 0.0, 1000.0}) {
            const SampledClip::Place place =
                clip->place(loops * clip->duration() + double(i) * kFrame, true);
            EXPECT_EQ(place.from, i);
            EXPECT_EQ(place.share, 0.0);
        }
    expectPlace(9.5 * kFrame, true, 9, 0, 0.5);
    expectPlace(-0.25 * kFrame, true, 9, 0, 0.75);
    expectPlace(9.5 * kFrame, false, 9, 9, 0.0);
    expectPlace(-1.0, false, 0, 0, 0.0);
    expectPlace(std::numeric_limits<double>::quiet_NaN(), true, 0, 0, 0.0);
    expectPlace(std::numeric_limits<double>::infinity(), false, 0, 0, 0.0);
    const auto single = SampledClip::create(someClip(1, 0.3), tubeRig());
    EXPECT_EQ(single->place(17.3, true).from, 0u);
    EXPECT_EQ(single->place(-17.3, true).to, 0u);
}

TEST(SampledClip, BlendsByTheShortestWayAtAnEvenSpeed) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < 20000; ++i) {
        osgSkin::JointSample a, b;
        a.rotation = test::randomRotation(random);
        // Small and large angles, on both sides of the switch from the sines to a series.
        const double angle = i % 2 == 0 ? 1.2 * share(random) : 1e-6 * share(random);
        b.rotation = a.rotation * glm::angleAxis(angle, test::randomUnit(random));
        if (i % 3 == 0) b.rotation = -b.rotation;
        const double t = share(random);
        const glm::dquat between = osgSkin::blend(a, b, t).rotation;
        const glm::dquat exact = glm::slerp(a.rotation, b.rotation, t);
        ASSERT_NEAR(std::abs(glm::dot(between, exact)), 1.0, 1e-14) << angle;
        ASSERT_NEAR(glm::length(between), 1.0, 1e-14);
        ASSERT_NEAR(glm::angle(glm::conjugate(a.rotation) *
                               (glm::dot(between, a.rotation) < 0.0 ? -between : between)),
                    t * angle, 1e-7);
    }
}

TEST(SampledClip, RefusesWhatCannotBeSampled) {
    EXPECT_THROW(SampledClip::create(osgSkin::Clip(), tubeRig()), osgSkin::Error);
    const osg::ref_ptr<osgAnimation::Animation> none = new osgAnimation::Animation;
    const osgAnimation::Animation& animation = *none;
    const osg::ref_ptr<osgAnimation::Skeleton> empty = new osgAnimation::Skeleton;
    EXPECT_THROW(SampledClip::create(animation, *empty), osgSkin::Error);
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    for (const double rate : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(SampledClip::create(animation, *skeleton, rate), osgSkin::Error);
    EXPECT_EQ(SampledClip::create(animation, *skeleton)->sampleCount(), 1u);
    osg::ref_ptr<osg::Group> nothing = new osg::Group;
    EXPECT_THROW(osgSkin::ClipCharacter::create(*nothing), osgSkin::Error);
}

TEST(ClipPlayer, PosesAsTheSkeletonDoes) {
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

TEST(ClipPlayer, PosesWhatItIsGiven) {
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

TEST(ClipPlayer, AJointThatTheClipHasNotGoesWithItsParent) {
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

TEST(ClipPlayer, ItsCopyPosesNothing) {
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

TEST(ClipPlayer, GoesForwardBackwardAndStands) {
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

TEST(ClipPlayer, TellsTheRootsWay) {
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

TEST(ClipPlayer, AWalkerInPlaceThatIsMovedByItsRootMotionIsTheWalkerThatMoves) {
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
            walker.node->preMult(walker.player->takeRootMatrix(copies->toWorld()));
            const Vertices moved = placedBy(mover, copies->toWorld());
            EXPECT_LE(difference(placedBy(walker, copies->toWorld()), moved), 2e-6 * kSize);
        }
        EXPECT_GT(walker.node->getMatrix().getTrans().length(), 0.5);
    }
}

TEST(ClipPlayer, RootMotionTurnsOnOverLoops) {
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

TEST(ClipPlayer, RootMotionTurnsByTheBlendOfTwoClips) {
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
        EXPECT_NEAR(std::atan2(way(2, 0), way(0, 0)), 1.2 * weight, 0.01) << weight;
    }
    copy.player->advance(kFrame);
    EXPECT_EQ(copy.player->takeRootMotion(), osg::Vec3d()) << "it is no Extracted one";
    EXPECT_TRUE(copy.player->takeRootMatrix().isIdentity());
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

TEST(ClipPlayer, IsAnUpdateCallback) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto clip = SampledClip::create(someClip(12, 0.8), character.rig);
    const auto copy = copies->makeInstance();
    copy.player->setLayer(0, {clip, 0.0, 2.0});
    osgUtil::UpdateVisitor visitor;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    visitor.setFrameStamp(stamp);
    for (const double time : {100.0, 100.1}) {
        stamp->setSimulationTime(time);
        copy.node->accept(visitor);
    }
    EXPECT_NEAR(copy.player->getLayer(0).time, 0.2, 1e-9);
    EXPECT_EQ(skinOf(*copy.node).getDeformCount(), 0u); // it has not been in view yet
}

using osgSkin::ClipPlayer;
using osgSkin::DeformableSkin;
using osgSkin::SampledClip;

namespace {

/// The tube's joints; `swapped` exchanges the names of the last two.
osgSkin::RestSkeleton namedRig(bool swapped) {
    osgSkin::RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0, 0, 0));
    rig.add(swapped ? "end" : "middle", 0, glm::dvec3(0, 2, 0));
    rig.add(swapped ? "middle" : "end", 1, glm::dvec3(0, 4, 0));
    return rig;
}

/// Each joint bends by a different angle.
osgSkin::Clip bentMotion() {
    osgSkin::Clip clip;
    clip.frameTime = 0.1;
    clip.frames = 2;
    clip.joints = 3;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        for (const double angle : {0.1, 0.4, 0.9})
            clip.rotations.push_back(glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
        clip.rootPositions.emplace_back(0, 0, 0);
    }
    return clip;
}

osg::ref_ptr<const SampledClip> bentClip(bool swapped) {
    return SampledClip::create(bentMotion(), namedRig(swapped));
}

std::vector<osg::Vec3> skinPosedBy(ClipPlayer& player, const DeformableSkin& skin) {
    EXPECT_TRUE(player.pose());
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray())
        .asVector();
}

/// The vertices of a player that has not played anything else.
std::vector<osg::Vec3> posedAfresh(const osg::ref_ptr<const osgSkin::SkinModel>& model,
                                   const osg::ref_ptr<const SampledClip>& clip) {
    const auto skin = test::makeSkin();
    skin->setSkin(test::makeGeometry(test::Tube()), model);
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {clip});
    return skinPosedBy(*player, *skin);
}

osg::ref_ptr<const osgSkin::SkinModel> modelWithOtherNames() {
    test::Tube tube;
    std::swap(tube.binding.joints[1].name, tube.binding.joints[2].name);
    return tube.model();
}

} // namespace

TEST(ClipTrust, JointsAreFoundByNameAndTheRootByItsMoves) {
    const osg::ref_ptr<const SampledClip> still = bentClip(false);
    EXPECT_EQ(still->find("root"), 0);
    EXPECT_EQ(still->find("end"), 2);
    EXPECT_EQ(still->find("nobody"), -1);
    EXPECT_EQ(still->rootJoint(), 0u); // no joint is translated
    osgSkin::Clip motion = bentMotion();
    motion.rootPositions[1].x = 3.0;
    const osg::ref_ptr<const SampledClip> going = SampledClip::create(motion, namedRig(false));
    EXPECT_EQ(going->rootJoint(), 0u);
    EXPECT_NEAR(glm::distance(going->sample(1)->translation, going->sample(0)->translation), 3.0,
                1e-12);
}

/// Memory is reused: a new clip may have the address of an old one.
TEST(ClipTrust, AClipIsNotItsAddress) {
    const auto skin = test::makeSkin();
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    osg::ref_ptr<const SampledClip> clip = bentClip(false);
    player->setLayer(0, {clip});
    const std::vector<osg::Vec3> before = skinPosedBy(*player, *skin);
    const void* const place = clip.get();
    player->setLayer(0, {});
    EXPECT_FALSE(player->pose()); // nothing plays
    clip = nullptr;
    std::vector<osg::ref_ptr<const SampledClip>> others;
    do others.push_back(bentClip(true));
    while (others.back() != place && others.size() < 3000);
    player->setLayer(0, {others.back()});
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), others.back()));
    EXPECT_NE(skinPosedBy(*player, *skin), before);
    RecordProperty("clipsUntilThen", static_cast<int>(others.size()));
}

TEST(ClipTrust, ASkinMayGetItsModelLater) {
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {bentClip(false)});
    EXPECT_FALSE(player->pose());
    skin->setSkin(test::makeGeometry(test::Tube()), test::Tube().model());
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip(false)));
    skin->setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip(false)));
}

/// Baked data are for the model that the character had then.
TEST(ClipTrust, ABakedSkinMayGetAnotherModel) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip(false);
    character->bake(clip);
    const auto copy = character->makeInstance(false);
    auto& skin = dynamic_cast<DeformableSkin&>(*copy.node->getChild(0)->asGroup()->getChild(0));
    copy.player->setLayer(0, {clip});
    EXPECT_EQ(skinPosedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
    skin.setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(skinPosedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
}

TEST(ClipTrust, EverySkinOfACharacterIsBaked) {
    const auto skeleton = test::makeBones();
    for (int i = 0; i < 2; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(100.0 * i, 0, 0));
        place->addChild(test::makeSkin());
        skeleton->addChild(place);
    }
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip(false);
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
        const auto& posed =
            static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        EXPECT_EQ(posed.asVector(), posedAfresh(skin->getModel(), clip)) << i;
        EXPECT_TRUE(skin->getBoundingBox().valid());
    }
    EXPECT_EQ(skins, 2u);
}

TEST(ClipTrust, NothingIsNotAdded) {
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(nullptr);
    player->addRigid(nullptr, "root", osg::Matrixd());
    player->setLayer(0, {bentClip(false)});
    EXPECT_TRUE(player->pose());
}

TEST(ClipTrust, ABakeThatFailsLeavesAllAsItWas) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    osgSkin::Clip bad = bentMotion();
    bad.rotations.back().w = std::nan(""); // of the last sample
    EXPECT_THROW(character->bake(SampledClip::create(bad, namedRig(false))), osgSkin::Error);
    EXPECT_FALSE(character->bakedBounds().valid());
    character->bake(bentClip(false));
    EXPECT_TRUE(character->bakedBounds().valid());
}

/// A key at the end of all times must not fill the memory.
TEST(ClipTrust, EndlessClipsAreNotSampled) {
    osgSkin::Clip slow = bentMotion();
    slow.frameTime = 1e12;
    const auto animation = osgSkin::makeAnimation(slow, namedRig(false));
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    EXPECT_THROW(SampledClip::create(*animation, *skeleton), osgSkin::Error);
    slow.frameTime = 0.1;
    const auto good = osgSkin::makeAnimation(slow, namedRig(false));
    EXPECT_THROW(SampledClip::create(*good, *skeleton, 1e300), osgSkin::Error);
    EXPECT_EQ(SampledClip::create(*good, *skeleton, 10.0)->sampleCount(), 2u);
}

/// osgAnimation stretches keys to the animation's duration.
TEST(ClipTrust, SamplesAreTakenAsFastAsTheAnimationPlays) {
    osgSkin::Clip motion = bentMotion();
    motion.rotations[4] = glm::angleAxis(1.4, glm::dvec3(1, 0, 0)); // the middle one rotates by 1
    const auto animation = osgSkin::makeAnimation(motion, namedRig(false));
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    const auto own = SampledClip::create(*animation, *skeleton, 40.0);
    animation->setDuration(2.0 * animation->getDuration());
    const auto slow = SampledClip::create(*animation, *skeleton, 20.0);
    ASSERT_EQ(slow->sampleCount(), own->sampleCount());
    EXPECT_NEAR(slow->duration(), 2.0 * own->duration(), 1e-6);
    for (std::size_t i = 0; i < own->sampleCount(); ++i)
        EXPECT_NEAR(glm::angle(slow->sample(i)[1].rotation), glm::angle(own->sample(i)[1].rotation),
                    1e-5);
    EXPECT_GT(glm::angle(own->sample(own->sampleCount() / 2)[1].rotation),
              glm::angle(own->sample(0)[1].rotation) + 0.3);
}

/// Clips that move other bones: none affects the next one, nor the scene.
TEST(ClipTrust, SamplingLeavesTheSkeletonAsItIs) {
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    const auto whole = osgSkin::makeAnimation(bentMotion(), namedRig(false));
    const auto onlyOf = [&whole](const char* bone) {
        const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        for (const auto& channel : whole->getChannels())
            if (channel->getTargetName() == bone) animation->addChannel(channel->clone());
        return animation;
    };
    const auto middle = SampledClip::create(*onlyOf("middle"), *skeleton, 10.0);
    const auto end = SampledClip::create(*onlyOf("end"), *skeleton, 10.0);
    const auto angleIn = [](const SampledClip& clip, const char* joint) {
        return glm::angle(clip.sample(0)[clip.find(joint)].rotation);
    };
    EXPECT_NEAR(angleIn(*middle, "middle"), 0.4, 1e-6);
    EXPECT_NEAR(angleIn(*middle, "end"), 0.0, 1e-6);
    EXPECT_NEAR(angleIn(*end, "end"), 0.9, 1e-6);
    EXPECT_NEAR(angleIn(*end, "middle"), 0.0, 1e-6);
}

/// The application's own callback may come before the one that moves the bone.
TEST(ClipTrust, BonesMayHaveOtherCallbacksFirst) {
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    osg::Node& root = *skeleton->getChild(0);
    const osg::ref_ptr<osg::Callback> update = root.getUpdateCallback();
    const osg::ref_ptr<osg::NodeCallback> own = new osg::NodeCallback;
    own->setNestedCallback(update);
    root.setUpdateCallback(own);
    const auto animation = osgSkin::makeAnimation(bentMotion(), namedRig(false));
    const auto clip = SampledClip::create(*animation, *skeleton, 10.0);
    EXPECT_NEAR(glm::angle(clip->sample(0)[clip->find("root")].rotation), 0.1, 1e-6);
}
