// SPDX-License-Identifier: MIT
// Walkers in programs that were not made for them: esmini and SUMO, as their sources read.
#include "Notices.h"
#include "WalkedPath.h"

#include <osg/LOD>
#include <osg/NodeCallback>
#include <osg/PositionAttitudeTransform>
#include <osgGA/EventVisitor>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <gtest/gtest.h>

#include <functional>

namespace {

/// Does not traverse.
class Blocking : public osg::NodeCallback {
    void operator()(osg::Node*, osg::NodeVisitor*) override {}
};

/// A scene as esmini builds it: each entity under an LOD whose update callback does not traverse;
/// event traversals come several times a frame; its frames have wall-clock times.
struct Host {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    unsigned int frame = 0;

    osg::ref_ptr<osg::PositionAttitudeTransform> add(osg::Node* model) {
        const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        lod->addChild(model, 0.0f, 1000.0f);
        lod->setUpdateCallback(new Blocking);
        const osg::ref_ptr<osg::PositionAttitudeTransform> place =
            new osg::PositionAttitudeTransform;
        place->addChild(lod);
        scene->addChild(place);
        return place;
    }

    void show(double wallTime) {
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(++frame);
        stamp->setSimulationTime(wallTime);
        for (int event = 0; event < 3; ++event) {
            osgGA::EventVisitor visitor;
            visitor.setFrameStamp(stamp);
            scene->accept(visitor);
        }
        osgUtil::UpdateVisitor update;
        update.setFrameStamp(stamp);
        scene->accept(update);
    }
};

constexpr unsigned int kEsminiFlags =
    osg::CopyOp::DEEP_COPY_DRAWABLES | osg::CopyOp::DEEP_COPY_NODES |
    osg::CopyOp::DEEP_COPY_STATEATTRIBUTES | osg::CopyOp::DEEP_COPY_STATESETS;

TEST(SimulatorHost, WalkerWalksWhereUpdatesDoNotReachIt) {
    Host host;
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const auto place = host.add(walker);
    for (int i = 0; i < 100; ++i) {
        place->setPosition({0.03 * i, 0, 0});
        host.show(0.02 * i);
    }
    EXPECT_NEAR(walker->speed(), 1.5, 0.05);
    EXPECT_GT(walker->phase(), 0.0);
}

/// A program that calls osgViewer's renderingTraversals() alone.
TEST(SimulatorHost, WalkerThatIsOnlyDrawnWarnsOnce) {
    const auto draw = [](bool isTold, bool isUpdated) {
        walking::Walk walk;
        const osg::ref_ptr<osgUtil::CullVisitor> cull = new osgUtil::CullVisitor;
        const osg::ref_ptr<osgUtil::StateGraph> states = new osgUtil::StateGraph;
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        const osg::ref_ptr<osg::Viewport> viewport = new osg::Viewport(0, 0, 64, 64);
        for (int i = 0; i < 20; ++i) {
            const osg::Vec3d place(0.02 * i, 0, 0);
            if (isUpdated) walk.show(place, 0.0, 1.0 / 60.0);
            walk.transform->setMatrix(osg::Matrixd::translate(place));
            if (isTold) walk.walker->setMotion(place, 0.0, 1.2, 1.0 / 60.0);
            const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
            stamp->setFrameNumber(unsigned(i));
            cull->reset();
            cull->setFrameStamp(stamp);
            cull->setStateGraph(states);
            cull->setRenderStage(stage);
            cull->pushViewport(viewport);
            cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::perspective(60, 1, 1, 90)));
            cull->pushModelViewMatrix(new osg::RefMatrix, osg::Transform::ABSOLUTE_RF);
            walk.transform->accept(*cull);
            cull->popModelViewMatrix();
            cull->popProjectionMatrix();
            cull->popViewport();
        }
    };
    const test::Notices notices;
    draw(true, false);
    draw(false, true);
    EXPECT_EQ(notices.text(), "");
    draw(false, false);
    EXPECT_TRUE(notices.say("does not walk without update or event traversals: expected "
                            "osgViewer's frame() or updateTraversal(), or setMotion()"))
        << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

TEST(SimulatorHost, WallTimeDoesNotMatterWithAStep) {
    const auto walkWith = [](const std::function<double(int)>& wallTime) {
        Host host;
        const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
        walker->setStep(0.05);
        const auto place = host.add(walker);
        std::vector<walking::Vertices> frames;
        for (int i = 0; i < 80; ++i) {
            place->setPosition({0.07 * std::min(i, 50), 0, 0});
            host.show(wallTime(i));
            frames.push_back(walking::verticesOf(*walker));
        }
        return frames;
    };
    const auto even = walkWith([](int i) { return 0.05 * i; });
    const auto slow = walkWith([](int i) { return 3.0 * i + (i % 3); });
    ASSERT_EQ(even.size(), slow.size());
    for (std::size_t i = 0; i < even.size(); ++i)
        EXPECT_EQ(walking::difference(even[i], slow[i]), 0.0) << i;
}

TEST(SimulatorHost, PauseThatDrawsKeepsTheStandingFigure) {
    Host host;
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const auto place = host.add(walker);
    for (int i = 0; i < 50; ++i) {
        place->setPosition({0.03 * i, 0, 0});
        host.show(0.02 * i);
    }
    for (int i = 50; i < 150; ++i) host.show(0.02 * i); // it stops, and stands
    const walking::Vertices paused = walking::verticesOf(*walker);
    for (int i = 150; i < 300; ++i) host.show(0.02 * i);
    EXPECT_EQ(walking::difference(paused, walking::verticesOf(*walker)), 0.0);
}

class CopiedWalker : public testing::TestWithParam<unsigned int> {};

TEST_P(CopiedWalker, HasItsOwnPhase) {
    Host host;
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const osg::ref_ptr<osg::Group> model = new osg::Group;
    model->addChild(walker);
    const osg::ref_ptr<osgSkin::Walker> copy = osg::clone(walker.get(), osg::CopyOp(GetParam()));
    ASSERT_EQ(copy->getGaits(), walker->getGaits());
    const auto first = host.add(model), second = host.add(copy);
    for (int i = 0; i < 80; ++i) {
        first->setPosition({0.03 * i, 0, 0});
        host.show(0.02 * i);
    }
    EXPECT_NEAR(walker->speed(), 1.5, 0.05);
    EXPECT_EQ(copy->speed(), 0.0);
    const walking::Vertices standing = walking::verticesOf(*walking::makeFigureWalker());
    EXPECT_LT(walking::difference(walking::verticesOf(*copy), standing), 1e-5);
    EXPECT_GT(walking::difference(walking::verticesOf(*walker), standing), 0.2);
    // They share what does not move.
    const auto skins = test::findNodes<osgSkin::DeformableSkin>(*host.scene);
    ASSERT_EQ(skins.size(), 2u);
    EXPECT_EQ(skins[0].node->getModel(), skins[1].node->getModel());
}

INSTANTIATE_TEST_SUITE_P(SimulatorHost, CopiedWalker,
                         testing::Values(unsigned(osg::CopyOp::SHALLOW_COPY), kEsminiFlags,
                                         unsigned(osg::CopyOp::DEEP_COPY_ALL)));

TEST(SimulatorHost, WalkerUnderSeveralTransformsStandsAndWarnsOnce) {
    Host host;
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const auto first = host.add(walker), second = host.add(walker);
    const test::Notices notices;
    for (int i = 0; i < 60; ++i) {
        first->setPosition({0.03 * i, 0, 0});
        second->setPosition({0.03 * i, 10, 0});
        host.show(0.02 * i);
    }
    EXPECT_NE(notices.warnings().find("expected a copy by osg::clone()"), std::string::npos);
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_EQ(walker->speed(), 0.0);
    // Alone again, it walks.
    host.scene->removeChild(second);
    for (int i = 60; i < 120; ++i) {
        first->setPosition({0.03 * i, 0, 0});
        host.show(0.02 * i);
    }
    EXPECT_NEAR(walker->speed(), 1.5, 0.05);
}

TEST(SimulatorHost, SharedWalkerStandsInAViewersScene) {
    Host host;
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera; // as a viewer's, above its scene
    camera->addChild(host.scene);
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const auto first = host.add(walker), second = host.add(walker);
    const test::Notices notices;
    for (int i = 0; i < 60; ++i) {
        first->setPosition({0.03 * i, 0, 0});
        second->setPosition({0.03 * i, 10, 0});
        host.show(0.02 * i);
    }
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_EQ(walker->speed(), 0.0);
}

TEST(SimulatorHost, WalkerUnderTwoGroupsOfOnePlaceWalks) {
    Host host;
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const osg::ref_ptr<osg::Group> both = new osg::Group, a = new osg::Group, b = new osg::Group;
    a->addChild(walker);
    b->addChild(walker);
    both->addChild(a);
    both->addChild(b);
    const auto place = host.add(both);
    const test::Notices notices;
    for (int i = 0; i < 60; ++i) {
        place->setPosition({0.03 * i, 0, 0});
        host.show(0.02 * i);
    }
    EXPECT_EQ(notices.text(), "");
    EXPECT_NEAR(walker->speed(), 1.5, 0.05);
}

} // namespace
