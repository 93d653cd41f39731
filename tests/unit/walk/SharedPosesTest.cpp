// SPDX-License-Identifier: MIT
// Walkers that are small on the screen.
#include "SmallCamera.h"
#include "WalkedPath.h"

#include "walk/SharedPoses.h"

#include <osg/Texture2D>

#include <gtest/gtest.h>

#include <set>

namespace {

using walking::Camera;
using walking::Walk;

constexpr double kNear = 3.0, kFar = 60.0; // m: about 460 and 23 pixels

const osgSkin::DeformableSkin& skinOf(osg::Node& scene) {
    static osg::ref_ptr<osgSkin::DeformableSkin> kept;
    // Not by a visitor, which would look at the pose.
    osg::Node* node = &scene;
    while (node->asGroup()) node = node->asGroup()->getChild(0);
    kept = dynamic_cast<osgSkin::DeformableSkin*>(node);
    return *kept;
}

TEST(SharedPoses, AreDrawnForAllWalkersThatAreFar) {
    const osg::ref_ptr<osgSkin::Walker> first = walking::makeFigureWalker();
    first->setVaried(false);
    Walk a(first), b(osg::clone(first.get(), osg::CopyOp()));
    Camera camera(kFar);
    for (int i = 0; i < 40; ++i) {
        for (Walk* walk : {&a, &b}) walk->show({0.03 * i, 0, 0}, 0.0, 0.02);
        const auto seen = camera.see(*a.transform);
        EXPECT_EQ(seen.size(), 1u);
        EXPECT_EQ(seen, camera.see(*b.transform)) << i;
    }
    EXPECT_EQ(skinOf(*a.transform).getDeformCount(), 0u);
}

TEST(SharedPoses, AreNotDrawnForNearOnes) {
    Walk walk;
    Camera close(kNear), away(kFar);
    const auto isShared = [&](Camera& camera) {
        walk.show({0.03 * walk.frame, 0, 0}, 0.0, 0.02);
        const auto seen = camera.see(*walk.transform);
        EXPECT_EQ(seen.size(), 1u);
        return skinOf(*walk.transform).getDrawBackend() != nullptr;
    };
    EXPECT_TRUE(isShared(close)); // nobody had seen it before
    EXPECT_FALSE(isShared(close));
    EXPECT_FALSE(isShared(away));
    EXPECT_TRUE(isShared(away));
    EXPECT_TRUE(isShared(close));
    // Of two cameras the nearer one counts.
    EXPECT_FALSE(isShared(close));
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(isShared(close));
        away.see(*walk.transform);
    }
    walk.walker->setOwnPoseSize(1e6);
    EXPECT_TRUE(isShared(close));
    walk.walker->setOwnPoseSize(0.0);
    EXPECT_FALSE(isShared(away));
}

TEST(SharedPoses, TakeThePlaceOfTheOwnVertices) {
    Walk walk;
    Camera camera(kNear), away(kFar);
    osg::observer_ptr<osg::Drawable> own;
    for (int i = 0; i < 2; ++i) {
        walk.show({0.03 * walk.frame, 0, 0}, 0.0, 0.02);
        own = const_cast<osg::Drawable*>(*camera.see(*walk.transform).begin());
    }
    EXPECT_EQ(own.get(), skinOf(*walk.transform).getDeformedGeometry());
    camera.see(*new osg::Group);
    for (int i = 0; i < 3; ++i) {
        walk.show({0.03 * walk.frame, 0, 0}, 0.0, 0.02);
        away.see(*walk.transform);
    }
    EXPECT_FALSE(own.valid());
}

TEST(SharedPoses, UpdatesReachWhatIsBelowTheWalker) {
    struct Count : osg::NodeCallback {
        void operator()(osg::Node*, osg::NodeVisitor*) override { ++frames; }
        int frames = 0;
    };
    Walk walk;
    walk.show({0, 0, 0}, 0.0, 0.02);
    const osg::ref_ptr<Count> count = new Count;
    const osg::ref_ptr<osg::Group> hat = new osg::Group;
    hat->setUpdateCallback(count);
    walk.walker->addChild(hat);
    walk.show({0.03, 0, 0}, 0.0, 0.02);
    EXPECT_EQ(count->frames, 1);
}

TEST(SharedPoses, ChangeBackOnlyWhereItIsClearlySmaller) {
    Walk walk;
    walk.show({0, 0, 0}, 0.0, 0.02);
    Camera camera(20.0);
    camera.see(*walk.transform);
    // From then on just below and just above what it takes.
    int changes = 0;
    bool wasShared = true;
    for (int i = 0; i < 40; ++i) {
        const double pixels = 1.6 / (2.0 * 20.0 * std::tan(osg::PI / 6.0)) * 1000.0;
        walk.walker->setOwnPoseSize(pixels * (i % 2 ? 1.02 : 0.98));
        walk.show({0, 0, 0}, 0.0, 0.02);
        camera.see(*walk.transform);
        const bool isShared = skinOf(*walk.transform).getDrawBackend() != nullptr;
        changes += isShared != wasShared;
        wasShared = isShared;
    }
    EXPECT_LE(changes, 1);
}

TEST(SharedPoses, ChangeOnceForAStartAndOnceForAStop) {
    Walk walk;
    Camera camera(23.0); // about 65 pixels
    double x = 0.0;
    int changes = 0;
    bool wasShared = true;
    const auto go = [&](int frames, double speed) {
        for (int i = 0; i < frames; ++i) {
            walk.show({x += speed / 60.0, 0, 0}, 0.0, 1.0 / 60.0);
            camera.see(*walk.transform);
            const bool isShared = skinOf(*walk.transform).getDrawBackend() != nullptr;
            if (isShared != wasShared) ++changes;
            wasShared = isShared;
        }
    };
    go(30, 0.0);
    EXPECT_EQ(changes, 0);
    go(120, 1.4);
    EXPECT_EQ(changes, 2); // its own pose, and a shared one again
    EXPECT_TRUE(wasShared);
    go(180, 0.0);
    EXPECT_EQ(changes, 4);
    EXPECT_TRUE(wasShared);
}

TEST(SharedPoses, DepthCamerasDoNotCount) {
    Walk walk;
    const osg::ref_ptr<osg::Camera> shadow = new osg::Camera;
    shadow->attach(osg::Camera::DEPTH_BUFFER, new osg::Texture2D);
    Camera close(kNear, shadow), away(kFar);
    for (int i = 0; i < 5; ++i) {
        walk.show({0.03 * i, 0, 0}, 0.0, 0.02);
        away.see(*walk.transform);
        close.see(*walk.transform);
        EXPECT_TRUE(skinOf(*walk.transform).getDrawBackend()) << i;
    }
}

/// Counts how often the bounds above are computed.
struct Counting : osg::Node::ComputeBoundingSphereCallback {
    osg::BoundingSphere computeBound(const osg::Node& node) const override {
        ++count;
        return node.computeBound();
    }
    mutable int count = 0;
};

TEST(SharedPoses, BoundsDoNotChangeWhileItMoves) {
    for (const double distance : {kNear, kFar}) {
        Walk walk;
        Camera camera(distance);
        const osg::ref_ptr<Counting> counting = new Counting;
        walk.walker->setComputeBoundingSphereCallback(counting);
        int before = 0;
        for (int i = 0; i < 100; ++i) {
            // Through a start, a run and a stop.
            const double way = 0.05 * std::clamp(i - 10, 0, 60);
            walk.show({way, 0, 0}, 0.0, 0.02);
            camera.see(*walk.transform);
            walk.walker->getBound();
            if (i == 13) before = counting->count;
            if (distance == kNear) {
                const auto& skin = skinOf(*walk.transform);
                for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(
                         *skin.getDeformedGeometry()->getVertexArray()))
                    EXPECT_TRUE(skin.getBoundingBox().contains(vertex, 1e-5f)) << i;
            }
        }
        EXPECT_EQ(counting->count, before) << distance;
    }
}

TEST(SharedPoses, VisitorsFindTheOwnPose) {
    const osg::ref_ptr<osgSkin::Walker> first = walking::makeFigureWalker();
    first->setVaried(false);
    const osg::ref_ptr<osgSkin::Walker> copy = osg::clone(first.get(), osg::CopyOp());
    first->setOwnPoseSize(0.0);
    Walk own(first), small(copy);
    Camera camera(kFar);
    for (int i = 0; i < 60; ++i) {
        for (Walk* walk : {&own, &small}) {
            walk->show({0.03 * i, 0, 0}, 0.0, 0.02);
            camera.see(*walk->transform);
        }
    }
    EXPECT_TRUE(skinOf(*small.transform).getDrawBackend());
    // Its feet stand where the clips have them, and not where they were put down.
    EXPECT_LT(walking::difference(walking::verticesOf(*own.transform),
                                  walking::verticesOf(*small.transform)),
              0.02);
}

TEST(SharedPoses, CopiesAreOutOfStep) {
    for (const bool varied : {true, false}) {
        const osg::ref_ptr<osgSkin::Walker> first = walking::makeFigureWalker();
        first->setVaried(varied);
        std::vector<Walk> abreast;
        for (int i = 0; i < 5; ++i) abreast.emplace_back(osg::clone(first.get(), osg::CopyOp()));
        for (int i = 0; i < 200; ++i)
            for (Walk& walk : abreast) walk.show({0.025 * i, 0, 0}, 0.0, 0.02);
        int inStep = 0; // of ten pairs
        for (std::size_t i = 0; i < abreast.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                inStep += std::abs(std::remainder(
                              abreast[i].walker->phase() - abreast[j].walker->phase(), 1.0)) < 0.02;
        if (varied)
            EXPECT_LE(inStep, 2);
        else
            EXPECT_EQ(inStep, 10);
    }
}

TEST(SharedPoses, AreFewerForSmallerFigures) {
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const auto skins = test::findNodes<osgSkin::DeformableSkin>(*walker);
    const osg::ref_ptr<const osgSkin::Gaits> gaits = walker->getGaits();
    const auto poses = osgSkin::SharedPoses::of(gaits, {skins.front().node});
    EXPECT_EQ(poses, osgSkin::SharedPoses::of(gaits, {skins.front().node}));
    osgSkin::GaitState gait(*gaits, poses->hipsHeight());
    for (unsigned int coarseness = 0; coarseness < 5; ++coarseness) {
        std::set<std::size_t> found;
        for (int i = 0; i < 1000; ++i) {
            gait.show(1.0, 0.0, 0.001 * i, 0.001);
            found.insert(poses->nearest(gait, coarseness));
        }
        EXPECT_EQ(found.size(), std::size_t{160} >> std::min(coarseness, 3u));
    }
}

} // namespace
