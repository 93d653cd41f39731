// SPDX-License-Identifier: MIT
//
// Vertices that the processor deforms come to the card through mapped memory, and are the same.
#include "GpuSubject.h"
#include "Notices.h"
#include "Pixels.h"

#include <osgSkinGpu/MappedUploads>

#include <gtest/gtest.h>

#include <functional>

namespace {

using osgViewer::ViewerBase;
using test::GpuStage;
using test::GpuSubject;

constexpr auto kCompatibility = test::EglWindow::Profile::Compatibility;

template <typename Array, typename Vector>
void expectSame(const osg::Array* expected, const std::vector<Vector>& is) {
    EXPECT_TRUE(static_cast<const Array&>(*expected).asVector() == is);
}

/// A context's buffers have the last pose of all skins, to the bit.
void expectOnCard(GpuStage& stage, const GpuSubject& subject, std::size_t context = 0) {
    for (const auto& skin : subject.skins) {
        const osg::Geometry& drawn = *skin->getDeformedGeometry();
        const int attribute = skin->getTangentAttribute();
        const GpuStage::Posed posed = stage.onCard(drawn, attribute, context);
        expectSame<osg::Vec3Array>(drawn.getVertexArray(), posed.positions);
        expectSame<osg::Vec3Array>(drawn.getNormalArray(), posed.normals);
        if (attribute >= 0)
            expectSame<osg::Vec4Array>(
                drawn.getVertexAttribArray(static_cast<unsigned int>(attribute)), posed.tangents);
    }
}

class MappedUploads : public testing::TestWithParam<ViewerBase::ThreadingModel> {
protected:
    /// Draws frames with a new pose each, and returns how many of the uploads were mapped.
    unsigned int draw(GpuStage& stage, int frames) {
        const unsigned int before = osgSkin::uploadCounts().mapped;
        for (int i = 0; i < frames; ++i) stage.frame(_time += 0.01);
        return osgSkin::uploadCounts().mapped - before;
    }

private:
    double _time = 0.0;
};

} // namespace

TEST_P(MappedUploads, BringPosesToTheCard) {
    for (const char* name : {"tube", "thrower"}) {
        GpuSubject subject(name);
        ASSERT_EQ(subject.reason, "");
        osgSkin::setMappedUploads(*subject.scene, true);
        GpuStage stage(subject.scene, kCompatibility, 1, GetParam());
        draw(stage, 8); // in which buffers and mapped memory are made
        for (int frames = 10; frames <= 13; ++frames) {
            const unsigned int mapped = draw(stage, frames);
            stage.viewer.stopThreading();
            EXPECT_GE(mapped, 5 * subject.skins.size()) << name;
            expectOnCard(stage, subject);
            stage.viewer.startThreading();
        }
        subject.scene->releaseGLObjects(nullptr);
    }
}

TEST_P(MappedUploads, LeaveSeveralContextsToOsg) {
    GpuSubject subject("tube");
    osgSkin::setMappedUploads(*subject.scene, true);
    GpuStage stage(subject.scene, kCompatibility, 2, GetParam());
    osgViewer::View& second = *stage.viewer.getView(1);
    second.setSceneData(new osg::Group);
    EXPECT_GT(draw(stage, 16), 0u);
    stage.viewer.stopThreading();
    second.setSceneData(subject.scene);
    stage.viewer.startThreading();
    draw(stage, 4); // in which the second context gets its buffers
    EXPECT_EQ(draw(stage, 5), 0u);
    stage.viewer.stopThreading();
    for (const std::size_t context : {0u, 1u}) expectOnCard(stage, subject, context);
    subject.scene->releaseGLObjects(nullptr);
}

INSTANTIATE_TEST_SUITE_P(Models, MappedUploads,
                         testing::Values(ViewerBase::SingleThreaded,
                                         ViewerBase::CullDrawThreadPerContext,
                                         ViewerBase::DrawThreadPerContext,
                                         ViewerBase::CullThreadPerCameraDrawThreadPerContext));

namespace {

struct PlainDraw : osg::Drawable::DrawCallback {
    void drawImplementation(osg::RenderInfo& renderInfo,
                            const osg::Drawable* drawable) const override {
        drawable->drawImplementation(renderInfo);
    }
};

osg::ref_ptr<osg::Image> pictureOf(GpuStage& stage) {
    return new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
}

} // namespace

TEST(MappedUpload, GivesTheSamePictures) {
    for (const bool withArrayObjects : {false, true}) {
        const test::Notices notices;
        std::vector<osg::ref_ptr<osg::Image>> pictures[2];
        for (const bool isMapped : {false, true}) {
            GpuSubject subject("thrower");
            for (const auto& skin : subject.skins) skin->setUseVertexArrayObject(withArrayObjects);
            osgSkin::setMappedUploads(*subject.scene, isMapped);
            GpuStage stage(subject.scene);
            const unsigned int before = osgSkin::uploadCounts().mapped;
            for (int i = 0; i < 12; ++i) {
                stage.frame(0.1 * i);
                pictures[isMapped ? 1 : 0].push_back(pictureOf(stage));
            }
            EXPECT_EQ(osgSkin::uploadCounts().mapped > before, isMapped);
            subject.scene->releaseGLObjects(nullptr);
        }
        EXPECT_GT(test::seenPixels(*pictures[0].front()), 4000u);
        EXPECT_GT(test::unlikePixels(*pictures[0][6], *pictures[0][7]), 100u);
        for (std::size_t i = 0; i < pictures[0].size(); ++i)
            EXPECT_EQ(test::unlikePixels(*pictures[0][i], *pictures[1][i]), 0u) << i;
        EXPECT_EQ(notices.text(), "");
    }
}

TEST(MappedUpload, MayBeSwitchedOffAtAnyTime) {
    GpuSubject subject("tube");
    osgSkin::DeformableSkin& skin = *subject.skins.front();
    GpuStage stage(subject.scene);
    const auto frames = [&](double from) {
        for (int i = 0; i < 9; ++i) stage.frame(from + 0.01 * i);
    };
    const osg::ref_ptr<PlainDraw> draw = new PlainDraw;
    const auto check = [&](const char* what, const std::function<void()>& change) {
        SCOPED_TRACE(what);
        osgSkin::setMappedUploads(skin, true);
        frames(0.0);
        // Written, but not fetched yet.
        stage.viewer.advance(0.5);
        stage.viewer.updateTraversal();
        const unsigned int refused = osgSkin::uploadCounts().refused;
        skin.getDeformedGeometry();
        EXPECT_EQ(osgSkin::uploadCounts().refused, refused);
        change();
        stage.viewer.renderingTraversals();
        expectOnCard(stage, subject);
        frames(0.6);
        expectOnCard(stage, subject);
    };
    check("off", [&] { osgSkin::setMappedUploads(skin, false); });
    check("a draw callback", [&] { skin.setDrawCallback(draw); });
    skin.setDrawCallback(nullptr);
    check("eager", [&] { skin.setEager(true); });
    skin.setEager(false);
    check("no change", [] {});
    subject.scene->releaseGLObjects(nullptr);
}

TEST(MappedUpload, IsCopied) {
    const GpuSubject subject("tube");
    osgSkin::DeformableSkin& skin = *subject.skins.front();
    EXPECT_EQ(osgSkin::setMappedUploads(*subject.scene, true), 1u);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy = osg::clone(&skin, osg::CopyOp::SHALLOW_COPY);
    EXPECT_TRUE(copy->getDrawBackend());
    EXPECT_NE(copy->getDrawBackend(), skin.getDrawBackend());
    osgSkin::setMappedUploads(skin, false);
    EXPECT_FALSE(skin.getDrawBackend());
}

TEST(OldDriver, UploadsByOsg) {
    GpuSubject subject("tube");
    osgSkin::setMappedUploads(*subject.scene, true);
    GpuStage stage(subject.scene);
    for (int i = 0; i < 9; ++i) stage.frame(0.01 * i);
    EXPECT_EQ(osgSkin::uploadCounts().mapped, 0u) << "run it by CTest, with an old driver";
    EXPECT_GT(osgSkin::uploadCounts().refused, 0u);
    expectOnCard(stage, subject);
    subject.scene->releaseGLObjects(nullptr);
}
