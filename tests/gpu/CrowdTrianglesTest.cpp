// SPDX-License-Identifier: MIT
//
// Limits of the triangles that a crowd draws, counted by the driver.
#include "CrowdPicture.h"
#include "crowd/CrowdView.h"

#include <gtest/gtest.h>
#include <osg/GLExtensions>

#include <limits>
#include <map>

namespace {

using osgSkin::CrowdLevels;
using osgSkin::GpuCrowd;
using test::GpuStage;
using CrowdTriangles = test::CrowdTest;

constexpr GLenum kPrimitivesGenerated = 0x8C87;

/// Counts the triangles that a camera draws.
class TriangleCount {
public:
    explicit TriangleCount(osg::Camera& camera) {
        camera.setInitialDrawCallback(new Begin(*this));
        camera.setPostDrawCallback(new End(*this));
    }
    GLuint triangles = 0;

private:
    struct Begin : osg::Camera::DrawCallback {
        explicit Begin(TriangleCount& count) : of(count) {}
        void operator()(osg::RenderInfo& info) const override {
            const auto& gl = *info.getState()->get<osg::GLExtensions>();
            gl.glGenQueries(1, &of._query);
            gl.glBeginQuery(kPrimitivesGenerated, of._query);
        }
        TriangleCount& of;
    };
    struct End : osg::Camera::DrawCallback {
        explicit End(TriangleCount& count) : of(count) {}
        void operator()(osg::RenderInfo& info) const override {
            const auto& gl = *info.getState()->get<osg::GLExtensions>();
            gl.glEndQuery(kPrimitivesGenerated);
            gl.glGetQueryObjectuiv(of._query, GL_QUERY_RESULT_ARB, &of.triangles);
            gl.glDeleteQueries(1, &of._query);
        }
        TriangleCount& of;
    };
    GLuint _query = 0;
};

/// A crowd of several levels on a stage that shows all of it.
struct CountedCrowd {
    explicit CountedCrowd(GpuCrowd* crowd) : stage(crowd), of(crowd) {
        stage.setSphere({{7.5, 7.5, 2.0}, 13.0});
        stage.look({0.4, -1.0, 0.3}, 1.5);
    }
    ~CountedCrowd() { of->releaseGLObjects(nullptr); }
    GLuint draw() {
        stage.draw();
        return count.triangles;
    }
    GpuStage stage;
    TriangleCount count{*stage.viewer.getView(0)->getCamera()};
    GpuCrowd* of;
};

} // namespace

TEST_F(CrowdTriangles, StayBelowTheirLimit) {
    const auto character = subject.character();
    character->addLevel(0.5, 0.2);
    character->addLevel(0.25, 0.1);
    character->addLevel(0.1, 0.05);
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    CountedCrowd counted(crowd);
    std::map<GLuint, osg::ref_ptr<osg::Image>> byTheCard;
    for (const GpuCrowd::Culling culling : kCullings) {
        crowd->setCulling(culling);
        crowd->setMaxTriangles(0);
        const GLuint all = counted.draw();
        const osg::ref_ptr<osg::Image> picture =
            new osg::Image(counted.stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
        crowd->setMaxTriangles(all);
        EXPECT_EQ(counted.draw(), all);
        EXPECT_EQ(test::unlikePixels(counted.stage.picture(), *picture), 0u);
        GLuint before = all;
        for (const GLuint limit : {all - 1, all * 3 / 4, all / 2, all / 3}) {
            crowd->setMaxTriangles(limit);
            const GLuint drawn = counted.draw();
            EXPECT_LE(drawn, limit) << "of " << all;
            EXPECT_GE(drawn, limit * 6 / 10) << "of " << all;
            EXPECT_LE(drawn, before);
            before = drawn;
            const osg::Image& is = counted.stage.picture();
            const auto known = byTheCard.find(limit);
            if (known == byTheCard.end())
                byTheCard[limit] = new osg::Image(is, osg::CopyOp::DEEP_COPY_ALL);
            else
                EXPECT_EQ(test::unlikePixels(is, *known->second), 0u) << limit;
        }
        crowd->setMaxTriangles(1);
        EXPECT_EQ(counted.draw(), subject.members.size() * character->triangleCount(3))
            << "all in the last level";
    }
}

TEST_F(CrowdTriangles, LimitIsCopied) {
    const auto character = subject.character();
    character->addLevel(0.1, 0.01);
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    crowd->setMaxTriangles(1);
    const osg::ref_ptr<GpuCrowd> copy = osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(CountedCrowd(copy).draw(), subject.members.size() * character->triangleCount(1));
    crowd->setInstances({subject.members.front()});
    EXPECT_EQ(CountedCrowd(crowd).draw(), character->triangleCount(1)) << "other members";
}

/// The nearest members keep the most triangles, and no limit takes more than it must.
TEST(CrowdLevels, RaisesSizesAlike) {
    const auto character = test::CrowdSubject(1).character();
    character->addLevel(0.5, 0.2);
    character->addLevel(0.25, 0.1);
    const CrowdLevels levels(*character);
    const std::vector<unsigned int>& triangles = levels.triangles();
    ASSERT_EQ(triangles.size(), 3u);
    EXPECT_EQ(levels.levelOf(0.2f, 0), 0u);
    EXPECT_EQ(levels.levelOf(0.1999f, 0), 1u);
    EXPECT_EQ(levels.levelOf(0.39f, 16), 1u);
    EXPECT_EQ(levels.levelOf(0.42f, 16), 0u);
    std::vector<float> sizes;
    for (int i = 1; i < 400; ++i) sizes.push_back(0.002f * static_cast<float>(i));
    const auto sum = [&](int steps) {
        unsigned int all = 0;
        for (const float size : sizes) all += triangles[levels.levelOf(size, steps)];
        return all;
    };
    for (int steps = 0; steps < CrowdLevels::kBins; ++steps) {
        EXPECT_LE(sum(steps + 1), sum(steps));
        EXPECT_EQ(sum(levels.stepsFor(sizes, sum(steps))), sum(steps));
        std::size_t level = 2;
        for (const float size : sizes) { // ascending
            EXPECT_LE(levels.levelOf(size, steps), level);
            level = levels.levelOf(size, steps);
        }
    }
    EXPECT_EQ(levels.stepsFor(sizes, sum(0)), 0);
    EXPECT_GT(levels.stepsFor(sizes, sum(0) - 1), 0);
    EXPECT_EQ(levels.stepsFor(sizes, 1), CrowdLevels::kBins);
    EXPECT_EQ(sum(CrowdLevels::kBins), 399u * triangles[2]);
    EXPECT_EQ(levels.levelOf(std::numeric_limits<float>::infinity(), CrowdLevels::kBins), 2u);
}
