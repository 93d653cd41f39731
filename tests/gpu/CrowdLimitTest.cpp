// SPDX-License-Identifier: MIT
// Crowds that are larger than a driver reads, or than one dispatch looks at.
#include "CrowdPicture.h"

#include "crowd/CrowdDraws.h"

#include <osg/Geode>
#include <osg/Shape>
#include <osg/ShapeDrawable>

#include <limits>

namespace {

using osgSkin::CrowdInstance;
using osgSkin::TexelCheck;
using test::GpuStage;
using CrowdLimits = test::CrowdTest;

/// What draws a drawable, and counts how often.
struct CountedDraw : osg::Drawable::DrawCallback {
    void drawImplementation(osg::RenderInfo& renderInfo,
                            const osg::Drawable* drawable) const override {
        ++count;
        drawable->drawImplementation(renderInfo);
    }
    mutable int count = 0;
};

unsigned int seenOf(osg::Drawable::DrawCallback* draw) {
    const osg::ref_ptr<osg::ShapeDrawable> ball =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f));
    ball->setUseDisplayList(false);
    ball->setDrawCallback(draw);
    const osg::ref_ptr<osg::Geode> scene = new osg::Geode;
    scene->addDrawable(ball);
    GpuStage stage(scene);
    stage.look({0.0, -1.0, 0.0}, 3.0);
    stage.draw();
    return test::seenPixels(stage.picture());
}

} // namespace

TEST_F(CrowdLimits, BuffersThatTheDriverDoesNotReadAreNotDrawn) {
    EXPECT_GT(seenOf(new TexelCheck(65536, nullptr)), 1000u) << "what OpenGL promises";
    EXPECT_EQ(seenOf(new TexelCheck(std::numeric_limits<std::size_t>::max(), nullptr)), 0u);
}

TEST_F(CrowdLimits, ADrawableIsDrawnByItsOwnCallback) {
    const osg::ref_ptr<CountedDraw> own = new CountedDraw;
    EXPECT_GT(seenOf(new TexelCheck(1, own)), 1000u);
    EXPECT_GT(own->count, 0);
}

TEST_F(CrowdLimits, MoreMembersThanADispatchLooksAtAreDrawn) {
    constexpr std::size_t kMost = std::size_t{65535} * 64;
    const auto character = subject.character();
    CrowdInstance away = subject.members.front();
    away.position += osg::Vec3d(0.0, 0.0, 1e6);
    std::vector<CrowdInstance> members(kMost + 1, away);
    members.back() = subject.members.front();
    const auto alone = pictureOf(crowdOf(character, {subject.members.front()}));
    EXPECT_GT(test::seenPixels(*alone), 50u);
    EXPECT_EQ(test::unlikePixels(*pictureOf(crowdOf(character, members)), *alone), 0u);
}
