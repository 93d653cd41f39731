// SPDX-License-Identifier: MIT
//
// Skins deformed by compute shaders look like those deformed on the CPU.
//
// Results of the compute shaders compared with the CPU's.
#include "GpuSubject.h"
#include "Pixels.h"
#include "SlopedTube.h"
#include "TubeSkin.h"

#include <osgSkinGpu/GpuSkin>

#include <gtest/gtest.h>
#include <osg/DisplaySettings>
#include <osg/LightSource>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>

#include <cstdlib>
#include <sstream>

namespace {

using test::EglWindow;
using test::GpuStage;
using test::GpuSubject;

/// A scene around the subject, and its context.
struct Manner {
    const char* name;
    const char* subject;
    osg::ref_ptr<osg::Group> (*around)(osg::Group& subject);
    EglWindow::Profile profile = EglWindow::Profile::Compatibility;
};

std::ostream& operator<<(std::ostream& out, const Manner& manner) {
    return out << manner.name;
}

osg::ref_ptr<osg::Group> plain(osg::Group& subject) {
    return &subject;
}

osg::ref_ptr<osg::Group> shadowed(osg::Group& subject) {
    const osg::BoundingSphere sphere = subject.getBound();
    const float r = sphere.radius();
    const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene;
    const osg::ref_ptr<osgShadow::ShadowMap> map = new osgShadow::ShadowMap;
    map->setTextureSize(osg::Vec2s(256, 256));
    map->setTextureUnit(1);
    scene->setShadowTechnique(map);
    scene->setReceivesShadowTraversalMask(1);
    scene->setCastsShadowTraversalMask(2);
    const osg::ref_ptr<osg::ShapeDrawable> floor = new osg::ShapeDrawable(
        new osg::Box(sphere.center() - osg::Vec3(0, 0, r), 5 * r, 5 * r, 0.1f * r));
    floor->setNodeMask(1);
    subject.setNodeMask(3);
    const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(0.4f, -0.3f, 1, 0));
    map->setLight(light);
    scene->addChild(floor);
    scene->addChild(&subject);
    scene->addChild(light);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    return root;
}

osg::ref_ptr<osg::Group> shaded(osg::Group& subject, const char* vertex, const char* fragment) {
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(&subject);
    // Like a rendering technique that draws everything with one program.
    root->getOrCreateStateSet()->setAttribute(program, osg::StateAttribute::ON |
                                                           osg::StateAttribute::OVERRIDE);
    return root;
}

osg::ref_ptr<osg::Group> oldShader(osg::Group& subject) {
    return shaded(subject,
                  "#version 120\n"
                  "varying vec3 n;\n"
                  "void main() { n = gl_NormalMatrix * gl_Normal; gl_Position = ftransform(); }\n",
                  "#version 120\n"
                  "varying vec3 n;\n"
                  "void main() { gl_FragColor = vec4(normalize(n) * 0.5 + 0.5, 1.0); }\n");
}

osg::ref_ptr<osg::Group> coreShader(osg::Group& subject) {
    return shaded(subject,
                  "#version 330 core\n"
                  "in vec4 osg_Vertex; in vec3 osg_Normal;\n"
                  "uniform mat4 osg_ModelViewProjectionMatrix; uniform mat3 osg_NormalMatrix;\n"
                  "out vec3 n;\n"
                  "void main() { n = osg_NormalMatrix * osg_Normal;\n"
                  "  gl_Position = osg_ModelViewProjectionMatrix * osg_Vertex; }\n",
                  "#version 330 core\n"
                  "in vec3 n; out vec4 colour;\n"
                  "void main() { colour = vec4(normalize(n) * 0.5 + 0.5, 1.0); }\n");
}

const Manner kManners[] = {
    {"plain", "thrower", plain},
    {"with_a_shadow_map", "thrower", shadowed},
    {"with_a_users_shader", "thrower", oldShader},
    {"in_a_core_profile", "tube", coreShader, EglWindow::Profile::Core},
};

class GpuPicture : public testing::TestWithParam<Manner> {
protected:
    static osg::ref_ptr<osg::Image> take(GpuStage& stage, double time) {
        stage.draw(time);
        return new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
    }
};

using Hint = osg::DisplaySettings::VertexBufferHint;

} // namespace

TEST_P(GpuPicture, MatchesTheCpu) {
    GpuSubject subject(GetParam().subject);
    ASSERT_EQ(subject.reason, "");
    subject.poses = 4; // more of them would be too similar
    const osg::ref_ptr<osg::Group> scene = GetParam().around(*subject.scene);
    const bool isCore = GetParam().profile == EglWindow::Profile::Core;
    if (isCore) osg::DisplaySettings::instance()->setVertexBufferHint(Hint::VERTEX_ARRAY_OBJECT);
    {
        GpuStage stage(scene, GetParam().profile);
        if (isCore) stage.viewer.getView(0)->setLightingMode(osg::View::NO_LIGHT);
        const osg::ref_ptr<osg::Image> before = take(stage, subject.timeOf(1));
        const osg::ref_ptr<osg::Image> expected = take(stage, subject.timeOf(3));
        const unsigned int dispatches = osgSkin::gpuCounts().dispatches;
        osgSkin::setGpu(*scene, true);
        for (const int pose : {1, 3, 1, 3}) take(stage, subject.timeOf(pose));
        const osg::ref_ptr<osg::Image> is = take(stage, subject.timeOf(3));
        EXPECT_EQ(osgSkin::gpuCounts().dispatches - dispatches, 4 * subject.skins.size());
        EXPECT_GT(test::seenPixels(*expected), 4000u);
        EXPECT_GT(test::unlikePixels(*before, *expected), 300u) << "another pose would be seen";
        const unsigned int unlike = test::unlikePixels(*is, *expected);
        EXPECT_LE(unlike, GpuStage::kSize * GpuStage::kSize * 2 / 10000);
        std::cout << GetParam().name << ": " << unlike << " pixels of "
                  << GpuStage::kSize * GpuStage::kSize << std::endl;
        scene->releaseGLObjects(nullptr); // objects must not outlive their context
    }
    osg::DisplaySettings::instance()->setVertexBufferHint(Hint::NO_PREFERENCE);
}

INSTANTIATE_TEST_SUITE_P(Manners, GpuPicture, testing::ValuesIn(kManners),
                         [](const auto& manner) { return std::string(manner.param.name); });

namespace {

using osgViewer::ViewerBase;

class GpuThreads : public testing::TestWithParam<ViewerBase::ThreadingModel> {};

} // namespace

TEST_P(GpuThreads, OneDispatchAndBarrierPerPoseAndContext) {
    GpuSubject subject("tube");
    osgSkin::setGpu(*subject.scene, true);
    const unsigned int contexts = 2, poses = 10;
    {
        GpuStage stage(shadowed(*subject.scene), EglWindow::Profile::Compatibility, contexts,
                       GetParam());
        stage.frame(0.0); // in which a context may not know its capabilities yet
        stage.frame(0.0);
        stage.viewer.stopThreading();
        stage.viewer.startThreading();
        const osgSkin::GpuCounts before = osgSkin::gpuCounts();
        for (unsigned int i = 1; i <= poses; ++i) stage.frame(0.01 * i);
        for (int i = 0; i < 3; ++i) stage.frame(0.01 * poses); // with nothing new
        stage.viewer.stopThreading();
        const osgSkin::GpuCounts seen = osgSkin::gpuCounts();
        EXPECT_EQ(seen.dispatches - before.dispatches, poses * contexts);
        EXPECT_EQ(seen.barriers - before.barriers, poses * contexts);
        EXPECT_LE(test::difference(*subject.skins.front(), stage.computed(*subject.skins.front()))
                      .positions,
                  1e-6);
        // The shadow's own camera would still see it.
        for (unsigned int i = 0; i < contexts; ++i)
            stage.viewer.getView(i)->setSceneData(subject.scene);
        stage.lookAway();
        stage.viewer.startThreading();
        for (unsigned int i = 1; i <= poses; ++i) stage.frame(1.0 + 0.01 * i);
        stage.viewer.stopThreading();
        const osgSkin::GpuCounts away = osgSkin::gpuCounts();
        EXPECT_EQ(away.dispatches, seen.dispatches);
        EXPECT_EQ(away.barriers, seen.barriers);
        subject.scene->releaseGLObjects(nullptr);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, GpuThreads,
                         testing::Values(ViewerBase::SingleThreaded,
                                         ViewerBase::CullDrawThreadPerContext,
                                         ViewerBase::DrawThreadPerContext,
                                         ViewerBase::CullThreadPerCameraDrawThreadPerContext));

TEST(OldDriver, FallsBackToTheCpu) {
    GpuSubject subject("tube");
    GpuStage stage(subject.scene);
    stage.draw(0.3);
    const osg::ref_ptr<osg::Image> expected =
        new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
    osgSkin::setGpu(*subject.scene, true);
    stage.draw(0.2);
    stage.draw(0.3);
    EXPECT_EQ(osgSkin::gpuCounts().dispatches, 0u) << "run it by CTest, with an old driver";
    EXPECT_GT(test::seenPixels(*expected), 4000u);
    EXPECT_EQ(test::unlikePixels(stage.picture(), *expected), 0u);
}

namespace {

using test::GpuStage;
using test::GpuSubject;

class GpuSkin : public testing::TestWithParam<std::string> {};

/// The default subjects, or OSGSKIN_GPU_SUBJECTS, separated by commas.
std::vector<std::string> subjects() {
    const char* named = std::getenv("OSGSKIN_GPU_SUBJECTS");
    std::istringstream list(named ? named : "tube,small,large,morphs,thrower,climber");
    std::vector<std::string> names;
    for (std::string name; std::getline(list, name, ',');) names.push_back(name);
    return names;
}

} // namespace

TEST_P(GpuSkin, PositionsNormalsAndTangentsMatchTheCpu) {
    GpuSubject subject(GetParam());
    if (!subject.reason.empty()) GTEST_SKIP() << subject.reason;
    osgSkin::setGpu(*subject.scene, true);
    GpuStage stage(subject.scene);
    test::Difference most;
    for (int pose = 0; pose < subject.poses; ++pose) {
        const double time = subject.timeOf(pose);
        stage.draw(time);
        for (const auto& skin : subject.skins) {
            // Deformed only for the comparisons so far, not for drawing.
            EXPECT_EQ(skin->getDeformCount(), static_cast<unsigned int>(pose));
            most.take(test::difference(*skin, stage.computed(*skin)));
        }
    }
    EXPECT_LE(most.positions, 1e-6) << "of the extent";
    // Each from the reference: where skin folds, both round, and their errors may add up.
    EXPECT_LE(most.computedError, 4e-6);
    EXPECT_LE(most.deformedError, 2e-6);
    EXPECT_LE(most.tangents, 3e-6);
    std::cout << GetParam() << ": positions " << most.positions << " of the extent, normals "
              << most.normals << " (from the reference " << most.computedError
              << ", the processor's " << most.deformedError << "), tangents " << most.tangents
              << std::endl;
}

/// At the limits of bone scale the squared length of a direction is beyond single precision.
TEST(GpuSkinScale, NormalsMatchTheCpuAtAnyScale) {
    const test::SlopedTube tube;
    for (const double scale : {0.99e9, 1.01e-9})
        for (const std::size_t scaled : {1u, 2u}) {
            SCOPED_TRACE(std::to_string(scale) + " of joint " + std::to_string(scaled));
            const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
            skin->setSkin(test::makeGeometry(tube), tube.model());
            osgSkin::setGpu(*skin, true);
            const std::vector<osgSkin::JointMap> maps = tube.scaledMaps(scaled, scale);
            ASSERT_TRUE(skin->setPose(maps.data(), maps.size()));
            GpuStage stage(skin);
            stage.draw();
            const GpuStage::Posed posed = stage.computed(*skin);
            const auto& expected =
                static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getNormalArray());
            for (std::size_t v = 0; v < posed.normals.size(); ++v)
                ASSERT_LE((posed.normals[v] - expected[v]).length(), 2e-3f) << v;
            skin->releaseGLObjects(nullptr);
        }
}

/// As a crowd: see CrowdTest.cpp.
TEST(GpuSkinState, DrawsInASecondWindow) {
    osg::ref_ptr<osg::Image> pictures[2];
    for (osg::ref_ptr<osg::Image>& picture : pictures) {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        {
            GpuSubject subject("tube");
            osgSkin::setGpu(*subject.scene, true);
            scene->addChild(subject.scene);
        }
        GpuStage stage(scene);
        stage.draw(0.8);
        picture = new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
        scene->removeChildren(0, scene->getNumChildren());
        stage.draw(0.9);
    }
    EXPECT_GT(test::seenPixels(*pictures[0]), 1000u);
    EXPECT_EQ(test::unlikePixels(*pictures[0], *pictures[1]), 0u);
}

TEST(GpuSkinState, KeepsUseOfVertexArrayObjects) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osgSkin::setGpu(*skin, true);
    GpuStage stage(skin);
    for (const bool used : {true, false, true}) {
        skin->setUseVertexArrayObject(used);
        test::bend(*skin, used ? 0.4 : 0.7);
        stage.draw();
        const osg::Geometry* drawn = skin->getDrawBackend()->cull(*skin, *stage.cullVisitor());
        ASSERT_TRUE(drawn);
        EXPECT_EQ(drawn->getUseVertexArrayObject(), used);
    }
    skin->releaseGLObjects(nullptr);
}

TEST(GpuOption, SwitchesSkinsOfLoadedScenes) {
    const std::string file = std::string(OSGSKIN_DATA) + "/thrower.skin";
    for (const char* option : {"gpu=on", "gpu=off"}) {
        const osg::ref_ptr<osg::Node> scene =
            osgDB::readRefNodeFile(file, new osgDB::Options(option));
        ASSERT_TRUE(scene);
        ASSERT_FALSE(test::skinsIn(*scene).empty());
        for (const auto& skin : test::skinsIn(*scene)) {
            EXPECT_EQ(skin->getDrawBackend() != nullptr, std::string(option) == "gpu=on");
            const osg::ref_ptr<osgSkin::DeformableSkin> copy =
                osg::clone(skin.get(), osg::CopyOp::SHALLOW_COPY);
            EXPECT_EQ(copy->getDrawBackend() != nullptr, skin->getDrawBackend() != nullptr);
            EXPECT_TRUE(!copy->getDrawBackend() ||
                        copy->getDrawBackend() != skin->getDrawBackend());
        }
    }
    EXPECT_FALSE(osgDB::readRefNodeFile(file, new osgDB::Options("gpu=perhaps")));
}

TEST_P(GpuSkin, GivesTheSameBitsTwice) {
    GpuSubject subject(GetParam());
    if (!subject.reason.empty()) GTEST_SKIP() << subject.reason;
    osgSkin::setGpu(*subject.scene, true);
    GpuStage::Posed before;
    for (int run = 0; run < 2; ++run) {
        GpuStage stage(subject.scene);
        stage.draw(subject.timeOf(1));
        const GpuStage::Posed posed = stage.computed(*subject.skins.front());
        if (run == 0) before = posed;
        EXPECT_EQ(posed.positions, before.positions);
        EXPECT_EQ(posed.normals, before.normals);
        EXPECT_EQ(posed.tangents, before.tangents);
        subject.scene->releaseGLObjects(nullptr);
    }
}

INSTANTIATE_TEST_SUITE_P(Subjects, GpuSkin, testing::ValuesIn(subjects()),
                         [](const auto& subject) { return subject.param; });
