// SPDX-License-Identifier: MIT
// A skin in a window must look like a plain geometry with the same vertices, in every drawing mode
// of OSG.
#include "Pixels.h"
#include "TubeSkin.h"
#include "Window.h"

#include <osg/DisplaySettings>
#include <osg/Light>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgUtil/GLObjectsVisitor>

#include <gtest/gtest.h>

#include <map>
#include <memory>

namespace {

using osgViewer::ViewerBase;

const osg::Vec3d kEye(14, 3, 2);
const osg::Vec3d kCentre(0, 3, 2);
constexpr double kAngle = 1.2;

/// The skin's current vertices in an OSG geometry.
osg::ref_ptr<osg::Geometry> plain(const osgSkin::DeformableSkin& skin) {
    const osg::Geometry& posed = *skin.getDeformedGeometry();
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const auto copy = [](const osg::Array* array) {
        return osg::clone(array, osg::CopyOp::DEEP_COPY_ALL);
    };
    geometry->setVertexArray(copy(posed.getVertexArray()));
    geometry->setNormalArray(copy(posed.getNormalArray()), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(osg::clone(posed.getPrimitiveSet(0), osg::CopyOp::DEEP_COPY_ALL));
    return geometry;
}

osg::ref_ptr<osg::Geometry> plainAt(double angle) {
    const auto skin = test::makeSkin();
    test::bend(*skin, angle);
    return plain(*skin);
}

const osg::Image& expected(double angle) {
    static std::map<double, osg::ref_ptr<osg::Image>> pictures;
    osg::ref_ptr<osg::Image>& picture = pictures[angle];
    if (!picture) {
        test::Windows window(plainAt(angle), kEye, kCentre);
        window.frame();
        picture = window.pictures().front();
    }
    return *picture;
}

using Hint = osg::DisplaySettings::VertexBufferHint;

/// Settings for drawing the scene.
struct Manner {
    const char* name;
    Hint hint; ///< of contexts
    void (*set)(osgSkin::DeformableSkin& skin);
};

std::ostream& operator<<(std::ostream& out, const Manner& manner) {
    return out << manner.name;
}

void askForLists(osgSkin::DeformableSkin& skin) {
    osgUtil::GLObjectsVisitor lists(osgUtil::GLObjectsVisitor::SWITCH_ON_DISPLAY_LISTS |
                                    osgUtil::GLObjectsVisitor::SWITCH_OFF_VERTEX_BUFFER_OBJECTS);
    skin.accept(lists);
}

const Manner kManners[] = {
    {"plain", Hint::NO_PREFERENCE, [](osgSkin::DeformableSkin&) {}},
    {"no_buffer_objects", Hint::NO_PREFERENCE,
     [](osgSkin::DeformableSkin& skin) { skin.setUseVertexBufferObjects(false); }},
    {"array_objects", Hint::NO_PREFERENCE,
     [](osgSkin::DeformableSkin& skin) { skin.setUseVertexArrayObject(true); }},
    {"context_with_array_objects", Hint::VERTEX_ARRAY_OBJECT, [](osgSkin::DeformableSkin&) {}},
    {"context_with_buffer_objects", Hint::VERTEX_BUFFER_OBJECT,
     [](osgSkin::DeformableSkin& skin) { skin.setUseVertexBufferObjects(false); }},
    {"display_lists_asked_for", Hint::NO_PREFERENCE, askForLists},
    {"eager", Hint::NO_PREFERENCE, [](osgSkin::DeformableSkin& skin) { skin.setEager(true); }},
};

class Drawn : public testing::TestWithParam<Manner> {
protected:
    Drawn() {
        osg::DisplaySettings::instance()->setVertexBufferHint(GetParam().hint);
        window = std::make_unique<test::Windows>(skin, kEye, kCentre);
        window->frame(); // a context reads the hint when it first draws
        osg::DisplaySettings::instance()->setVertexBufferHint(Hint::NO_PREFERENCE);
        GetParam().set(*skin);
    }
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    std::unique_ptr<test::Windows> window;
};

} // namespace

TEST_P(Drawn, EveryFrameShowsItsPose) {
    for (const double angle : {0.0, 0.4, kAngle, -0.8, kAngle, kAngle}) {
        test::bend(*skin, angle);
        window->frame();
        const auto picture = window->pictures().front();
        EXPECT_GT(test::seenPixels(*picture), 2000u);
        EXPECT_EQ(test::unlikePixels(*picture, expected(angle)), 0u) << angle;
    }
}

TEST_P(Drawn, ShowsItsPoseAfterCompileResizeAndRelease) {
    window->frame();
    skin->resizeGLObjectBuffers(4);
    test::bend(*skin, 0.5);
    window->frame();
    skin->releaseGLObjects(nullptr);
    test::bend(*skin, kAngle);
    window->frame();
    osg::GraphicsContext& context = *window->viewer.getView(0)->getCamera()->getGraphicsContext();
    ASSERT_TRUE(context.makeCurrent());
    osg::RenderInfo info(context.getState(), nullptr);
    skin->compileGLObjects(info);
    context.releaseContext();
    window->frame();
    EXPECT_EQ(test::unlikePixels(*window->pictures().front(), expected(kAngle)), 0u);
}

INSTANTIATE_TEST_SUITE_P(Manners, Drawn, testing::ValuesIn(kManners),
                         [](const auto& manner) { return std::string(manner.param.name); });

namespace {

struct Threads {
    const char* name;
    ViewerBase::ThreadingModel model;
};
const Threads kThreads[] = {
    {"SingleThreaded", ViewerBase::SingleThreaded},
    {"CullDrawThreadPerContext", ViewerBase::CullDrawThreadPerContext},
    {"DrawThreadPerContext", ViewerBase::DrawThreadPerContext},
    {"CullThreadPerCameraDrawThreadPerContext",
     ViewerBase::CullThreadPerCameraDrawThreadPerContext},
};

std::ostream& operator<<(std::ostream& out, const Threads& threads) {
    return out << threads.name;
}

class Threaded : public testing::TestWithParam<Threads> {};

/// A floor, a light above it, and a figure that casts a shadow.
osg::ref_ptr<osg::Group> shadowed(osg::Node* figure) {
    const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene;
    const osg::ref_ptr<osgShadow::ShadowMap> map = new osgShadow::ShadowMap;
    map->setTextureSize(osg::Vec2s(1024, 1024));
    map->setTextureUnit(1);
    scene->setShadowTechnique(map);
    scene->setReceivesShadowTraversalMask(1);
    scene->setCastsShadowTraversalMask(2);
    const osg::ref_ptr<osg::ShapeDrawable> floor =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, -1, 0), 20, 0.5f, 20));
    floor->setNodeMask(1);
    figure->setNodeMask(3);
    const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(4, 30, 3, 0));
    map->setLight(light);
    scene->addChild(floor);
    scene->addChild(figure);
    scene->addChild(light);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    return root;
}

const osg::Vec3d kAbove(12, 22, 16);

} // namespace

TEST_P(Threaded, TwoContextsShowTheSamePose) {
    const auto skin = test::makeSkin();
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(skin);
    test::Windows windows(scene, kEye, kCentre, 2, GetParam().model);
    const unsigned int poses = 20;
    for (unsigned int i = 1; i <= poses; ++i) {
        test::bend(*skin, kAngle * i / poses);
        windows.frame();
    }
    EXPECT_EQ(skin->getDeformCount(), poses); // once for both
    for (int i = 0; i < 4; ++i) windows.frame();
    for (const auto& picture : windows.pictures())
        EXPECT_EQ(test::unlikePixels(*picture, expected(kAngle)), 0u);
    EXPECT_EQ(skin->getDeformCount(), poses);
}

TEST_P(Threaded, ShadowAndColourShowTheSamePose) {
    const auto skin = test::makeSkin();
    test::Windows windows(shadowed(skin), kAbove, osg::Vec3d(), 2, GetParam().model);
    const unsigned int poses = 8;
    for (unsigned int i = 1; i <= poses; ++i) {
        test::bend(*skin, kAngle * i / poses);
        windows.frame();
    }
    EXPECT_EQ(skin->getDeformCount(), poses); // once for a shadow pass and two views' colour passes
    if (GetParam().model != ViewerBase::SingleThreaded)
        for (int i = 0; i < 4; ++i) windows.frame();
    test::Windows reference(shadowed(plainAt(kAngle)), kAbove, osg::Vec3d());
    reference.frame();
    const auto is = windows.pictures().front();
    const auto should = reference.pictures().front();
    // A few pixels on the shadow's border may differ by rounding.
    EXPECT_LE(test::unlikePixels(*is, *should), 20u);
    // The previous pose would be visible, so the test can fail.
    test::Windows before(shadowed(plainAt(kAngle * (poses - 1) / poses)), kAbove, osg::Vec3d());
    before.frame();
    EXPECT_GT(test::unlikePixels(*before.pictures().front(), *should), 200u);
}

INSTANTIATE_TEST_SUITE_P(Models, Threaded, testing::ValuesIn(kThreads),
                         [](const auto& threads) { return std::string(threads.param.name); });
