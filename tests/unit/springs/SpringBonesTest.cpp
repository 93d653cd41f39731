// SPDX-License-Identifier: MIT
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/Error>
#include <osgSkinMotion/RotateBone>
#include <osgSkinMotion/SpringBones>
#include <osgSkinRig/MakeSkeleton>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using osg::Vec3d;
using osgSkin::find;
using osgSkin::SpringBones;
using osgSkin::SpringSettings;

constexpr double kFrame = 1.0 / 60.0;

/// A head on a neck, with a tail of three joints that points back; Y up, in centimetres.
osgSkin::RestSkeleton tailRig() {
    osgSkin::RestSkeleton rig;
    const int neck = rig.add("Neck", -1, glm::dvec3(0, 140, 0));
    const int head = rig.add("Head", neck, glm::dvec3(0, 150, 0));
    int above = rig.add("Tail1", head, glm::dvec3(0, 160, -10));
    above = rig.add("Tail2", above, glm::dvec3(0, 160, -20));
    rig.add("Tail3", above, glm::dvec3(0, 160, -30));
    return rig;
}

SpringSettings tailSprings(const std::string& centre = "") {
    SpringSettings::Joint like;
    like.drag = 0.4;
    like.gravity = glm::dvec3(0, -0.2, 0);
    like.radius = 2.0;
    SpringSettings settings;
    settings.chains.push_back(springsBelow(tailRig(), {"Tail1"}, like));
    settings.chains.back().centre = centre;
    return settings;
}

osg::Matrixd toWorld() {
    return osg::Matrixd::scale(0.01, 0.01, 0.01) * osg::Matrixd::rotate(osg::PI_2, Vec3d(1, 0, 0));
}

/// A figure whose head a callback turns.
struct Figure {
    explicit Figure(const SpringSettings& settings = tailSprings(), double size = 1.0)
        : skeleton(osgSkin::makeSkeleton(tailRig())),
          springs(new SpringBones(settings, toWorld())) {
        place->setMatrix(osg::Matrixd::scale(size, size, size));
        upright->addChild(skeleton);
        place->addChild(upright);
        osgSkin::attach(*skeleton, *springs);
        bone("Head")->addUpdateCallback(turn);
    }

    struct Turn : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv);
            osgSkin::rotateBone(static_cast<osgAnimation::Bone&>(*node),
                                osg::Quat(angle, Vec3d(0, 1, 0)));
        }
        double angle = 0.0;
    };

    osgAnimation::Bone* bone(const std::string& name) const {
        for (const auto& found : test::findNodes<osgAnimation::Bone>(*skeleton))
            if (found.node->getName() == name) return found.node;
        return nullptr;
    }

    void frame() { test::updateAt(*place, time += kFrame); }

    /// The direction of the tail's first bone in the skeleton's space.
    Vec3d tail() const {
        Vec3d way = bone("Tail2")->getMatrixInSkeletonSpace().getTrans() -
                    bone("Tail1")->getMatrixInSkeletonSpace().getTrans();
        way.normalize();
        return way;
    }
    double degreesTo(const Vec3d& direction) const {
        return osg::RadiansToDegrees(std::acos(std::min(1.0, tail() * direction)));
    }

    osg::ref_ptr<osgAnimation::Skeleton> skeleton;
    osg::ref_ptr<SpringBones> springs;
    osg::ref_ptr<Turn> turn = new Turn;
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(toWorld());
    double time = 0.0;
};

const Vec3d kBack(0, 0, -1), kDown(0, -1, 0), kLeft(1, 0, 0);

TEST(SpringBones, HangFromTheFirstFrameOn) {
    Figure figure;
    figure.frame();
    const double first = figure.degreesTo(kBack);
    EXPECT_GT(first, 5.0);
    for (int i = 0; i < 120; ++i) figure.frame();
    EXPECT_NEAR(figure.degreesTo(kBack), first, 1.0);
    EXPECT_GT(figure.tail() * kDown, 0.05);
}

/// As the first joints of skirts: rounding must not turn them.
TEST(SpringBones, OfNearlyNoLengthFollowTheirParents) {
    SpringSettings settings = tailSprings();
    settings.chains[0].joints[0].tip = glm::dvec3(0, 160, -10 - 1e-5);
    Figure figure(settings);
    for (int i = 0; i < 240; ++i) {
        figure.place->setMatrix(osg::Matrixd::translate(0.37 + 0.01 * i, 0.1, 0.003 * i));
        figure.turn->angle = 0.01 * i;
        figure.frame();
        const osg::Quat turn = osg::Matrixd(figure.bone("Tail1")->getMatrix()).getRotate();
        EXPECT_NEAR(std::abs(turn.w()), 1.0, 1e-9) << i;
    }
}

TEST(SpringBones, LagBehindAMoveAndComeBack) {
    Figure figure;
    for (int i = 0; i < 60; ++i) figure.frame();
    const Vec3d atRest = figure.tail();
    for (int i = 1; i <= 30; ++i) {
        figure.place->setMatrix(osg::Matrixd::translate(0.05 * i, 0, 0)); // 3 m/s to the left
        figure.frame();
    }
    EXPECT_LT(figure.tail() * kLeft, -0.3);
    for (int i = 0; i < 120; ++i) figure.frame();
    EXPECT_GT(figure.tail() * atRest, 0.999);
}

TEST(SpringBones, FollowWhatOtherCallbacksDo) {
    Figure figure;
    for (int i = 1; i <= 20; ++i) {
        figure.turn->angle = osg::DegreesToRadians(4.0 * i);
        figure.frame();
    }
    const Vec3d pose = osg::Quat(figure.turn->angle, Vec3d(0, 1, 0)) * kBack;
    EXPECT_GT(figure.degreesTo(pose), 15.0); // lags
    for (int i = 0; i < 120; ++i) figure.frame();
    EXPECT_LT(figure.degreesTo(pose), 20.0); // hangs
}

TEST(SpringBones, ActAfterCallbacksThatAreAddedToTheirBoneLater) {
    Figure figure;
    const osg::ref_ptr<Figure::Turn> neck = new Figure::Turn;
    figure.bone("Neck")->addUpdateCallback(neck);
    for (int i = 1; i <= 20; ++i) {
        neck->angle = osg::DegreesToRadians(4.0 * i);
        figure.frame();
    }
    EXPECT_GT(figure.degreesTo(osg::Quat(neck->angle, Vec3d(0, 1, 0)) * kBack), 15.0);
}

TEST(SpringBones, SharedByTwoSkeletonsHangStill) {
    Figure one;
    const osg::ref_ptr<osgAnimation::Skeleton> other = osgSkin::makeSkeleton(tailRig());
    other->getChild(0)->setUpdateCallback(one.springs);
    one.upright->addChild(other);
    one.frame();
    const Vec3d atRest = one.tail();
    EXPECT_GT(one.degreesTo(kBack), 5.0);
    for (int i = 1; i <= 30; ++i) {
        one.place->setMatrix(osg::Matrixd::translate(0.05 * i, 0, 0));
        one.frame();
        EXPECT_GT(one.tail() * atRest, 0.99999);
    }
}

TEST(SpringBones, WithACentreSwingByMovementBelowItAlone) {
    Figure figure(tailSprings("Neck"));
    for (int i = 0; i < 60; ++i) figure.frame();
    const Vec3d atRest = figure.tail();
    for (int i = 1; i <= 30; ++i) {
        figure.place->setMatrix(osg::Matrixd::translate(0.05 * i, 0, 0));
        figure.frame();
        EXPECT_GT(figure.tail() * atRest, 0.999);
    }
    for (int i = 1; i <= 10; ++i) {
        figure.turn->angle = osg::DegreesToRadians(6.0 * i);
        figure.frame();
    }
    EXPECT_GT(figure.degreesTo(osg::Quat(figure.turn->angle, Vec3d(0, 1, 0)) * kBack), 15.0);
}

TEST(SpringBones, AreTheSameForFiguresOfAnySize) {
    Figure one, giant(tailSprings(), 20.0);
    for (int i = 1; i <= 60; ++i) {
        one.place->setMatrix(osg::Matrixd::translate(0.03 * i, 0, 0));
        giant.place->setMatrix(osg::Matrixd::scale(20, 20, 20) *
                               osg::Matrixd::translate(0.6 * i, 0, 0));
        one.frame();
        giant.frame();
        EXPECT_GT(one.tail() * giant.tail(), 1.0 - 1e-9);
    }
}

TEST(SpringBones, HangInTheWorldWhereAFigureLies) {
    Figure figure;
    figure.place->setMatrix(osg::Matrixd::rotate(osg::PI, Vec3d(0, 1, 0))); // head down
    for (int i = 0; i < 60; ++i) figure.frame();
    EXPECT_LT(figure.tail() * kDown, -0.05);
}

TEST(SpringBones, AreCarriedAlongByATeleport) {
    Figure figure;
    for (int i = 0; i < 60; ++i) figure.frame();
    const Vec3d atRest = figure.tail();
    figure.place->setMatrix(osg::Matrixd::translate(500, 30, 0));
    for (int i = 0; i < 10; ++i) {
        figure.frame();
        EXPECT_GT(figure.tail() * atRest, 0.99999);
    }
}

TEST(SpringBones, LeavePosesThatAreNotFinite) {
    Figure figure, other;
    for (int i = 0; i < 60; ++i) {
        figure.turn->angle = i % 10 == 5 ? std::numeric_limits<double>::quiet_NaN() : 0.01 * i;
        other.turn->angle = 0.01 * i;
        figure.frame();
        other.frame();
        if (i % 10 != 5) {
            EXPECT_TRUE(figure.tail().valid());
        }
    }
    for (int i = 0; i < 60; ++i) {
        figure.frame();
        other.frame();
    }
    EXPECT_GT(figure.tail() * other.tail(), 0.9999);
    figure.place->setMatrix(osg::Matrixd::scale(0, 0, 0));
    figure.frame();
    figure.place->setMatrix(osg::Matrixd());
    figure.frame();
    EXPECT_TRUE(figure.tail().valid());
}

TEST(SpringBones, LookAtEachColliderOnceForAJoint) {
    const std::size_t many = 20'000;
    SpringSettings settings = tailSprings();
    ASSERT_EQ(settings.chains[0].joints.size(), 3u);
    settings.colliders.resize(many);
    for (SpringSettings::Collider& collider : settings.colliders) collider.joint = "Neck";
    settings.chains[0].colliders.assign(3 * many, 7);
    {
        const test::Notices notices;
        Figure(settings).frame();
        EXPECT_EQ(notices.text(), "");
    }
    for (std::size_t i = 0; i < many; ++i) settings.chains[0].colliders[i] = i;
    const test::Notices notices;
    Figure(settings).frame();
    EXPECT_TRUE(notices.say("10000 pairs of joints and colliders beyond 50000 are left out"))
        << notices.text();
}

TEST(SpringBones, StayOutOfACollider) {
    SpringSettings settings = tailSprings();
    settings.colliders.push_back({"Head", {0, 148, -22}, {0, 148, -22}, 9.0});
    settings.chains[0].colliders = {0};
    for (SpringSettings::Joint& joint : settings.chains[0].joints) joint.gravity.y = -2.0;
    Figure figure(settings), free([&] {
        settings.chains[0].colliders.clear();
        return settings;
    }());
    for (int i = 0; i < 60; ++i) {
        figure.frame();
        free.frame();
        const Vec3d tip = figure.bone("Tail3")->getMatrixInSkeletonSpace().getTrans();
        EXPECT_GE((tip - Vec3d(0, 148, -22)).length(), 11.0 - 1e-6);
    }
    const Vec3d through = free.bone("Tail3")->getMatrixInSkeletonSpace().getTrans();
    EXPECT_LT((through - Vec3d(0, 148, -22)).length(), 10.0);
}

TEST(SpringBones, LeaveThePoseWhereTheyAreOff) {
    Figure figure;
    figure.frame();
    figure.springs->setEnabled(false);
    figure.frame();
    EXPECT_LT(figure.degreesTo(kBack), 1e-4);
}

TEST(SpringBones, StartFromThePoseOfBonesWithoutACallback) {
    Figure figure;
    for (const char* name : {"Tail1", "Tail2", "Tail3"})
        figure.bone(name)->setUpdateCallback(nullptr);
    figure.frame();
    const double first = figure.degreesTo(kBack);
    for (int i = 0; i < 120; ++i) figure.frame();
    EXPECT_NEAR(figure.degreesTo(kBack), first, 1.0); // do not wind up
    figure.springs->setEnabled(false);
    figure.frame();
    EXPECT_LT(figure.degreesTo(kBack), 1e-4);
}

TEST(SpringBones, GoOnWhereABoneIsRemoved) {
    Figure figure;
    figure.frame();
    osgAnimation::Bone* const last = figure.bone("Tail3");
    last->getParent(0)->removeChild(last);
    figure.frame();
    figure.frame();
    EXPECT_TRUE(figure.tail().valid());
}

TEST(SpringBones, AreReplacedByOthers) {
    Figure figure;
    const osg::ref_ptr<SpringBones> none = new SpringBones(SpringSettings(), toWorld());
    EXPECT_EQ(find<SpringBones>(*figure.skeleton), figure.springs);
    osgSkin::attach(*figure.skeleton, *none);
    EXPECT_EQ(find<SpringBones>(*figure.skeleton), none);
    figure.frame();
    EXPECT_LT(figure.degreesTo(kBack), 1e-4);
}

TEST(SpringBones, NeedABone) {
    const osg::ref_ptr<osgAnimation::Skeleton> empty = new osgAnimation::Skeleton;
    const osg::ref_ptr<SpringBones> springs = new SpringBones;
    EXPECT_THROW(osgSkin::attach(*empty, *springs), osgSkin::Error);
}

class SavedSpringBones : public testing::TestWithParam<const char*> {};

TEST_P(SavedSpringBones, SwingAsBefore) {
    SpringSettings settings = tailSprings("Neck");
    settings.colliders.push_back({"Head", {0, 148, -22}, {1, 148, -22}, 9.0});
    settings.chains[0].colliders = {0};
    const Figure figure(settings);
    figure.bone("Head")->removeUpdateCallback(figure.turn);
    const std::string file = testing::TempDir() + "springs." + GetParam();
    ASSERT_TRUE(osgDB::writeNodeFile(*figure.place, file));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
    ASSERT_TRUE(read);
    const auto skeletons = test::findNodes<osgAnimation::Skeleton>(*read);
    ASSERT_EQ(skeletons.size(), 1u);
    const SpringBones* const springs = find<SpringBones>(*skeletons[0].node);
    ASSERT_TRUE(springs);
    EXPECT_EQ(springs->getToWorld(), toWorld());
    const SpringSettings& found = springs->getSettings();
    ASSERT_EQ(found.colliders.size(), 1u);
    EXPECT_EQ(found.colliders[0].joint, "Head");
    EXPECT_EQ(found.colliders[0].start, settings.colliders[0].start);
    EXPECT_EQ(found.colliders[0].end, settings.colliders[0].end);
    EXPECT_EQ(found.colliders[0].radius, 9.0);
    ASSERT_EQ(found.chains.size(), 1u);
    EXPECT_EQ(found.chains[0].centre, "Neck");
    EXPECT_EQ(found.chains[0].colliders, settings.chains[0].colliders);
    ASSERT_EQ(found.chains[0].joints.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j) {
        const SpringSettings::Joint &a = found.chains[0].joints[j],
                                    &b = settings.chains[0].joints[j];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.tip, b.tip);
        EXPECT_EQ(a.gravity, b.gravity);
        EXPECT_EQ(std::vector({a.stiffness, a.drag, a.radius}),
                  std::vector({b.stiffness, b.drag, b.radius}));
    }
    const osg::ref_ptr<osg::Node> copy = osg::clone(read.get(), osg::CopyOp::DEEP_COPY_ALL);
    const auto copied = test::findNodes<osgAnimation::Skeleton>(*copy);
    EXPECT_TRUE(find<SpringBones>(*copied[0].node));
    EXPECT_NE(find<SpringBones>(*copied[0].node), springs);
}

INSTANTIATE_TEST_SUITE_P(SpringBones, SavedSpringBones, testing::Values("osgb", "osgt", "osgx"));

TEST(SpringsBelow, TakesTipsFromTheSkeleton) {
    osgSkin::RestSkeleton rig = tailRig();
    const SpringSettings::Chain chain = springsBelow(rig, {"Tail1"}, {});
    ASSERT_EQ(chain.joints.size(), 3u);
    EXPECT_EQ(chain.joints[0].tip, glm::dvec3(0, 160, -20));
    EXPECT_EQ(chain.joints[2].tip, glm::dvec3(0, 160, -40)); // in line
    EXPECT_EQ(springsBelow(rig, {"Tail1"}, {}, 7.0).joints[2].tip, glm::dvec3(0, 160, -37));
    rig.joints[4].tip = glm::dvec3(0, 150, -35);
    EXPECT_EQ(springsBelow(rig, {"Tail3", "Tail2"}, {}).joints[1].tip, glm::dvec3(0, 150, -35));
    try {
        springsBelow(rig, {"Tial1"}, {});
        FAIL();
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"Tail1\""), std::string::npos)
            << error.what();
    }
}

} // namespace
