// SPDX-License-Identifier: MIT
//
// Clips that play without the bones' callbacks: the same pictures and bones as with them, and
// callbacks that run as soon as something needs them.
#include "PlayedFigure.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinMotion/ApplyFrame>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/CullVisitor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <functional>
#include <map>

namespace {

using osgSkin::AutoPlayManager;
using osgSkin::UpdatePlayedSkeleton;
using played::difference;
using played::verticesOf;

constexpr double kRounding = 1e-6 * played::kSize;

osg::ref_ptr<osg::Geometry> quad(double size) {
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
        vertices->push_back(osg::Vec3d(size * (x - 0.5), size * y + 4.0, 0.0));
    osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
    result->setVertexArray(vertices);
    result->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    return result;
}

/// A character as makeSkeleton() and loadCharacter() make it: a skin and a rigid part, and two
/// clips of an AutoPlayManager, the first of which plays.
struct Figure : played::Character {
    osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
    osg::ref_ptr<osgAnimation::Animation> other =
        osgSkin::makeAnimation(played::someClip(7, -0.4), rig);

    Figure() : played::Character(played::someClip(10, 0.7)) {
        rigid->removeChildren(0, 1);
        rigid->addChild(quad(2.0));
        other->setName("other");
        animation->setStartTime(0.0);
        manager->registerAnimations({animation, other});
        scene->setUpdateCallback(manager);
    }
    UpdatePlayedSkeleton& played() const { return *UpdatePlayedSkeleton::of(*skeleton); }
    osgAnimation::Bone& bone(const std::string& name) const { return *findBone(*skeleton, name); }
    osgAnimation::StackedTransform& stackOf(const std::string& name) const {
        return dynamic_cast<osgAnimation::UpdateBone&>(*bone(name).getUpdateCallback())
            .getStackedTransforms();
    }
    osg::Matrixd toWorld(const osg::Node& node) const {
        return osg::computeLocalToWorld(node.getParentalNodePaths(scene).at(0));
    }
    /// Plays two frames, since the first one moves bones.
    void start() const {
        update(0.0);
        update(0.01);
    }
};

double difference(const osg::Matrixd& a, const osg::Matrixd& b) {
    double largest = 0.0;
    for (int i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a.ptr()[i] - b.ptr()[i]));
    return largest;
}

/// Whether two figures show the same.
void expectSame(const Figure& a, const Figure& b, double time) {
    EXPECT_LT(difference(verticesOf(*a.skin), verticesOf(*b.skin)), kRounding) << time;
    EXPECT_LT(difference(a.toWorld(*a.rigid), b.toWorld(*b.rigid)), kRounding) << time;
}

/// A figure whose bones are always moved by osgAnimation's callbacks.
struct Following : Figure {
    Following() { played().setBonesFollow(true); }
};

class Played : public testing::Test {
protected:
    void update(double time) {
        figure.update(time);
        following.update(time);
    }
    void expectSkipping(double time) {
        update(time);
        EXPECT_TRUE(figure.played().skipsBones()) << time;
        EXPECT_FALSE(following.played().skipsBones());
        expectSame(figure, following, time);
        expectSameBones(time);
    }
    void expectFollowing(double time) {
        update(time);
        EXPECT_FALSE(figure.played().skipsBones()) << time;
        expectSame(figure, following, time);
        expectSameBones(time);
    }
    void expectSameBones(double time) {
        for (const char* name : {"root", "middle", "end"}) {
            EXPECT_LT(difference(figure.bone(name).getMatrixInSkeletonSpace(),
                                 following.bone(name).getMatrixInSkeletonSpace()),
                      kRounding)
                << name << time;
            EXPECT_LT(difference(figure.toWorld(figure.bone(name)),
                                 following.toWorld(following.bone(name))),
                      kRounding)
                << name << time;
        }
    }
    void SetUp() override {
        update(0.0);
        expectSkipping(0.04);
    }

    Figure figure;
    Following following;
};

} // namespace

TEST_F(Played, MovesBonesSkinAndRigidPart) {
    const osg::Matrixd before = figure.bone("end").getMatrixInSkeletonSpace();
    const osg::Matrixd part = figure.toWorld(*figure.rigid);
    const auto skin = verticesOf(*figure.skin);
    expectSkipping(0.2);
    EXPECT_GT(difference(figure.bone("end").getMatrixInSkeletonSpace(), before), 0.1);
    EXPECT_GT(difference(verticesOf(*figure.skin), skin), 0.1);
    EXPECT_GT(difference(figure.toWorld(*figure.rigid), part), 0.1);
    EXPECT_EQ(figure.rigid->getMatrix().compare(following.rigid->getMatrix()), 0);
}

TEST_F(Played, EveryPlayModeIsThatOfOsgAnimation) {
    using osgAnimation::Animation;
    for (const auto mode : {Animation::LOOP, Animation::PPONG, Animation::STAY, Animation::ONCE}) {
        for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
            one->animation->setPlayMode(mode);
            one->animation->setDuration(0.5); // slower than its keys
            one->manager->playAnimation(one->animation);
        }
        const double start = figure.animation->getStartTime();
        for (double time = start; time < start + 1.6; time += 0.037) {
            update(time);
            expectSame(figure, following, time);
            const bool isOver = mode == Animation::ONCE && time > start + 0.5;
            EXPECT_EQ(figure.played().skipsBones(), !isOver) << mode << " " << time;
        }
    }
}

TEST_F(Played, BackAndForthInTimeToTheFirstAndLastKey) {
    for (const double time : {0.1, 0.0, -0.2, 5.0, 0.3333, 1.0 / 30.0, 10.0 / 30.0, 0.02})
        expectSkipping(time);
}

TEST_F(Played, SteppedKeysAndElementsWithoutChannels) {
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        one->stackOf("middle").push_back(
            new osgAnimation::StackedScaleElement("scale", osg::Vec3(1.5f, 1.5f, 1.5f)));
        const osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
        const osg::ref_ptr<osgAnimation::QuatStepChannel> channel =
            new osgAnimation::QuatStepChannel;
        channel->setName("quaternion");
        channel->setTargetName("middle");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        for (int k = 0; k < 5; ++k)
            keys->push_back({0.1 * k, osg::Quat(0.3 * k, osg::Vec3d(1, 0, 0))});
        clip->addChannel(channel);
        one->manager->stopAll();
        one->manager->registerAnimation(clip);
        one->manager->playAnimation(clip);
    }
    update(0.05);
    for (const double time : {0.1, 0.15, 0.25, 0.31}) expectSkipping(time);
    // Changed by the application while the clip plays.
    for (Figure* one : {&figure, static_cast<Figure*>(&following)})
        static_cast<osgAnimation::StackedScaleElement*>(one->stackOf("middle").back().get())
            ->setScale(osg::Vec3(0.5f, 0.5f, 0.5f));
    expectSkipping(0.36);
}

TEST_F(Played, ChannelsOfOtherKindsMoveBones) {
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        const osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
        for (int twice = 0; twice < 2; ++twice) { // which osgAnimation blends
            const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
                new osgAnimation::QuatSphericalLinearChannel;
            channel->setName("quaternion");
            channel->setTargetName("middle");
            auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
            for (int k = 0; k < 5; ++k)
                keys->push_back({0.1 * k, osg::Quat(0.3 * k * (twice + 1), osg::Vec3d(1, 0, 0))});
            clip->addChannel(channel);
        }
        one->manager->stopAll();
        one->manager->registerAnimation(clip);
        one->manager->playAnimation(clip);
    }
    for (const double time : {0.1, 0.15, 0.25}) expectFollowing(time);
}

TEST_F(Played, AnotherClipAndTwoThatBlend) {
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        one->manager->stopAnimation(one->animation);
        one->manager->playAnimation(one->other);
    }
    for (const double time : {0.05, 0.1, 0.2}) expectSkipping(time);
    for (Figure* one : {&figure, static_cast<Figure*>(&following)})
        one->manager->playAnimation(one->animation, 0, 0.3f);
    for (const double time : {0.21, 0.25, 0.3}) expectFollowing(time);
    for (Figure* one : {&figure, static_cast<Figure*>(&following)})
        one->manager->stopAnimation(one->other);
    for (const double time : {0.31, 0.35}) expectSkipping(time);
    // The last pose stays.
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) one->manager->stopAll();
    for (const double time : {0.4, 0.5}) expectFollowing(time);
}

TEST_F(Played, ASwordOnAHandIsAtItsPlaceAtOnce) {
    const osg::ref_ptr<osg::Geode> sword = new osg::Geode;
    const osg::ref_ptr<osg::Geode> twin = new osg::Geode;
    figure.bone("end").addChild(sword);
    following.bone("end").addChild(twin);
    expectFollowing(0.1);
    EXPECT_LT(difference(figure.toWorld(*sword), following.toWorld(*twin)), kRounding);
    expectFollowing(0.15);
    EXPECT_LT(difference(figure.toWorld(*sword), following.toWorld(*twin)), kRounding);
    figure.bone("end").removeChild(sword);
    expectSkipping(0.2);
    // In exchange for a child, so that their number stays.
    figure.bone("end").replaceChild(figure.rigid, sword);
    update(0.25);
    EXPECT_FALSE(figure.played().skipsBones());
    EXPECT_LT(difference(figure.toWorld(*sword), following.toWorld(*twin)), kRounding);
}

TEST_F(Played, SomethingAnimatedBelowARigidPartIsUpdated) {
    struct Count : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            ++count;
            traverse(node, nv);
        }
        int count = 0;
    };
    const osg::ref_ptr<Count> count = new Count;
    const osg::ref_ptr<osg::Group> hat = new osg::Group;
    figure.rigid->addChild(hat);
    expectSkipping(0.08);
    hat->setUpdateCallback(count);
    expectFollowing(0.1);
    EXPECT_EQ(count->count, 1);
}

namespace {

/// Bends a bone after the clip has set it, as IK does.
struct Bend : osgAnimation::UpdateBone {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        auto* bone = static_cast<osgAnimation::Bone*>(node);
        const osg::Matrixd turn = osg::Matrixd::rotate(0.5, osg::Vec3d(0, 0, 1));
        bone->setMatrix(turn * osg::Matrixd::translate(0, 2, 0));
        bone->setMatrixInSkeletonSpace(bone->getMatrix() *
                                       bone->getBoneParent()->getMatrixInSkeletonSpace());
        traverse(node, nv);
    }
};

} // namespace

TEST_F(Played, OwnCallbacksOfBonesRun) {
    figure.bone("middle").setUpdateCallback(new Bend);
    following.bone("middle").setUpdateCallback(new Bend);
    for (const double time : {0.1, 0.2}) expectFollowing(time);
}

TEST_F(Played, CallbacksNestedInABonesRun) {
    const osg::ref_ptr<osg::Callback> before = figure.bone("middle").getUpdateCallback();
    figure.bone("middle").addUpdateCallback(new Bend);
    following.bone("middle").addUpdateCallback(new Bend);
    expectFollowing(0.1);
    figure.bone("middle").removeUpdateCallback(before->getNestedCallback());
    following.bone("middle").removeUpdateCallback(
        following.bone("middle").getUpdateCallback()->getNestedCallback());
    expectSkipping(0.2);
}

TEST_F(Played, CallbacksOnTheSkeletonRun) {
    const osg::ref_ptr<osg::NodeCallback> callback = new osg::NodeCallback;
    figure.skeleton->addUpdateCallback(callback);
    expectFollowing(0.1);
    figure.skeleton->removeUpdateCallback(callback);
    expectSkipping(0.2);
}

TEST_F(Played, BonesWithoutACallbackStayWhereTheyAreSet) {
    figure.bone("middle").setUpdateCallback(nullptr);
    following.bone("middle").setUpdateCallback(nullptr);
    expectFollowing(0.1);
}

TEST_F(Played, OsgsRigsReadTheBones) {
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    figure.skeleton->addChild(geode);
    expectSkipping(0.08);
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setSourceGeometry(quad(1.0));
    rig->setInfluenceMap(new osgAnimation::VertexInfluenceMap);
    geode->addDrawable(rig);
    expectFollowing(0.1);
}

TEST_F(Played, RunsBoneCallbacksOnRequest) {
    figure.played().setBonesFollow(true);
    expectFollowing(0.1);
    figure.played().setBonesFollow(false);
    expectSkipping(0.2);
    figure.played().poseBones();
    for (const char* name : {"root", "middle", "end"})
        EXPECT_LT(difference(figure.bone(name).getMatrixInSkeletonSpace(),
                             following.bone(name).getMatrixInSkeletonSpace()),
                  kRounding);
    expectSame(figure, following, 0.2);
    expectSkipping(0.3);
}

TEST_F(Played, AFrameThatIsAppliedShows) {
    const osgSkin::Clip clip = played::someClip(10, 0.7);
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        osgSkin::applyFrame(clip, one->rig, 4, *one->skeleton);
        osg::ref_ptr<osgSkin::UpdateDeformableSkin>(new osgSkin::UpdateDeformableSkin)
            ->pose(*one->skin, *one->skeleton);
    }
    expectSame(figure, following, 0.0);
    expectSkipping(0.3);
}

TEST_F(Played, AnotherManagerTakesOver) {
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> own =
            new osgAnimation::BasicAnimationManager;
        own->registerAnimation(one->other);
        one->scene->setUpdateCallback(own);
        own->playAnimation(one->other);
        one->other->setStartTime(0.1);
    }
    for (const double time : {0.1, 0.15, 0.2}) expectFollowing(time);
    for (Figure* one : {&figure, static_cast<Figure*>(&following)})
        one->scene->setUpdateCallback(one->manager);
    for (const double time : {0.21, 0.25}) expectSkipping(time);
    // Without any, the last pose stays.
    for (Figure* one : {&figure, static_cast<Figure*>(&following)})
        one->scene->setUpdateCallback(nullptr);
    for (const double time : {0.3, 0.4}) {
        figure.scene->addChild(new osg::Node);
        expectFollowing(time);
    }
}

TEST_F(Played, ACallbackOnTwoSkeletonsServesNeither) {
    const osg::ref_ptr<osgAnimation::Skeleton> second = osgSkin::makeSkeleton(figure.rig);
    second->setUpdateCallback(figure.skeleton->getUpdateCallback());
    figure.scene->addChild(second);
    for (const double time : {0.1, 0.2}) expectFollowing(time);
}

TEST_F(Played, ADeepCopyShowsThePoseAndPlaysOn) {
    const osg::ref_ptr<osg::Group> copy = osg::clone(
        figure.scene.get(), osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_CALLBACKS |
                                osg::CopyOp::DEEP_COPY_DRAWABLES);
    expectSame(figure, following, 0.04);
    const auto part = test::findNodes<osgSkin::RigidPart>(*copy).at(0);
    EXPECT_LT(difference(part.toWorld, following.toWorld(*following.rigid)), kRounding);
    EXPECT_LT(difference(verticesOf(played::skinOf(*copy)), verticesOf(*following.skin)),
              kRounding);
    const osg::ref_ptr<osg::Group> original = figure.scene;
    figure.scene = copy;
    for (const double time : {0.0, 0.1, 0.2}) figure.update(time);
    following.manager->playAnimation(following.animation);
    following.animation->setStartTime(0.0);
    following.update(0.2);
    const auto moved = test::findNodes<osgSkin::RigidPart>(*copy).at(0);
    EXPECT_LT(difference(moved.toWorld, following.toWorld(*following.rigid)), kRounding);
    EXPECT_LT(difference(verticesOf(played::skinOf(*copy)), verticesOf(*following.skin)),
              kRounding);
    const auto skeleton = test::findNodes<osgAnimation::Skeleton>(*copy).at(0);
    EXPECT_TRUE(UpdatePlayedSkeleton::of(*skeleton.node)->skipsBones());
    figure.scene = original;
    expectSkipping(0.25);
}

namespace {

/// The drawables that a cull traversal finds, with their matrices.
std::map<const osg::Drawable*, osg::Matrixd> cull(osg::Group& scene) {
    const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
    const osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    visitor->setFrameStamp(new osg::FrameStamp);
    visitor->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    visitor->setStateGraph(graph);
    visitor->setRenderStage(stage);
    visitor->pushViewport(new osg::Viewport(0, 0, 100, 100));
    visitor->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::ortho(-9, 9, -9, 9, -9, 9)));
    visitor->pushModelViewMatrix(new osg::RefMatrix, osg::Transform::ABSOLUTE_RF);
    scene.accept(*visitor);
    std::map<const osg::Drawable*, osg::Matrixd> result;
    const std::function<void(const osgUtil::StateGraph&)> collect =
        [&](const osgUtil::StateGraph& from) {
            for (const auto& leaf : from._leaves) result[leaf->getDrawable()] = *leaf->_modelview;
            for (const auto& child : from._children) collect(*child.second);
        };
    collect(*graph);
    return result;
}

} // namespace

TEST_F(Played, CullTraversalsDrawTheSame) {
    for (const double time : {0.1, 0.2}) {
        expectSkipping(time);
        const auto drawn = cull(*figure.scene);
        const auto expected = cull(*following.scene);
        ASSERT_EQ(expected.size(), 2u);
        ASSERT_EQ(drawn.size(), 2u);
        EXPECT_LT(difference(drawn.at(figure.rigid->getChild(0)->asDrawable()),
                             expected.at(following.rigid->getChild(0)->asDrawable())),
                  kRounding);
    }
    figure.bone("end").setNodeMask(0);
    update(0.25);
    EXPECT_TRUE(figure.played().skipsBones());
    EXPECT_EQ(cull(*figure.scene).size(), 1u);
    figure.bone("end").setNodeMask(~0u);
    figure.rigid->setNodeMask(0);
    update(0.3);
    EXPECT_EQ(cull(*figure.scene).size(), 1u);
}

TEST_F(Played, BoundsHoldSkinAndParts) {
    for (const double time : {0.1, 0.2, 0.3}) {
        expectSkipping(time);
        const osg::BoundingSphere bound = figure.scene->getBound();
        const osg::BoundingSphere expected = following.scene->getBound();
        EXPECT_LT(bound.radius(), 1.3f * expected.radius());
        const osg::Matrixd part = figure.toWorld(*figure.rigid);
        for (const osg::Vec3& v : verticesOf(figure.rigid->getChild(0)->asGeometry()))
            EXPECT_LT((v * part - bound.center()).length(), bound.radius() * 1.0001f);
        const osg::Matrixd skin = figure.toWorld(*figure.skeleton);
        for (const osg::Vec3& v : verticesOf(*figure.skin))
            EXPECT_LT((v * skin - bound.center()).length(), bound.radius() * 1.0001f);
    }
    // A node that is added later counts from the next update on.
    const osg::ref_ptr<osg::MatrixTransform> away =
        new osg::MatrixTransform(osg::Matrix::translate(100, 0, 0));
    away->addChild(quad(1.0));
    figure.bone("end").addChild(away);
    figure.update(0.35);
    EXPECT_GT(figure.scene->getBound().radius(), 45.0f);
}

TEST_F(Played, SkinAndPartsArePicked) {
    for (const double time : {0.1, 0.25}) {
        expectSkipping(time);
        const osg::Vec3d centre = osg::Vec3d(0.1, 5.0, 0.0) * figure.toWorld(*figure.rigid);
        const osg::Vec3d normal =
            osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), figure.toWorld(*figure.rigid));
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
            new osgUtil::LineSegmentIntersector(centre - normal, centre + normal);
        osgUtil::IntersectionVisitor visitor(line);
        figure.scene->accept(visitor);
        ASSERT_TRUE(line->containsIntersections()) << time;
        const auto& hit = line->getFirstIntersection();
        EXPECT_LT((hit.getWorldIntersectPoint() - centre).length(), 1e-5);
        EXPECT_EQ(hit.nodePath.at(hit.nodePath.size() - 2), figure.rigid);
        EXPECT_EQ(hit.nodePath.at(hit.nodePath.size() - 3), &figure.bone("end"));
    }
}

/// Props and others that a clip moves.
TEST_F(Played, OtherTransformsOfTheClipMove) {
    for (Figure* one : {&figure, static_cast<Figure*>(&following)}) {
        const osg::ref_ptr<osg::MatrixTransform> ball = new osg::MatrixTransform;
        ball->setName("ball");
        const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> update =
            new osgAnimation::UpdateMatrixTransform("ball");
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedTranslateElement("translate", osg::Vec3()));
        ball->setUpdateCallback(update);
        one->scene->addChild(ball);
        const osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel =
            new osgAnimation::Vec3LinearChannel;
        channel->setName("translate");
        channel->setTargetName("ball");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        keys->push_back({0.0, osg::Vec3()});
        keys->push_back({0.3, osg::Vec3(3, 0, 0)});
        one->animation->addChannel(channel);
        one->manager->dirty();
        one->manager->playAnimation(one->animation);
        one->animation->setStartTime(0.0);
    }
    for (const double time : {0.1, 0.2}) {
        expectSkipping(time);
        const auto* ball = static_cast<osg::MatrixTransform*>(
            figure.scene->getChild(figure.scene->getNumChildren() - 1));
        EXPECT_NEAR(ball->getMatrix().getTrans().x(), 10.0 * time, 1e-5);
    }
}
