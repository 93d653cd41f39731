// SPDX-License-Identifier: MIT
//
// Skins and crowds are ready for their first frame after one of OSG's compile visitors.
#include "CrowdSubject.h"
#include "GpuStage.h"
#include "GpuSubject.h"
#include "Pixels.h"

#include <osgSkinGpu/GpuCrowd>
#include <osgSkinGpu/GpuSkin>

#include <gtest/gtest.h>
#include <osg/GLExtensions>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

namespace {

using osgUtil::GLObjectsVisitor;
using test::GpuStage;

constexpr unsigned int kMode =
    GLObjectsVisitor::COMPILE_DISPLAY_LISTS | GLObjectsVisitor::COMPILE_STATE_ATTRIBUTES;

/// As a viewer does when it is realized, and osgDB's pager for databases.
void visit(osg::Node& scene, osg::RenderInfo& info) {
    GLObjectsVisitor visitor(kMode);
    visitor.setRenderInfo(info);
    scene.accept(visitor);
}

/// As IncrementalCompileOperation: it collects, and compiles bit by bit.
void collect(osg::Node& scene, osg::RenderInfo& info) {
    osgUtil::StateToCompile visitor(kMode, nullptr);
    scene.accept(visitor);
    for (osg::Texture* texture : visitor._textures) texture->apply(*info.getState());
    for (osg::Program* program : visitor._programs) program->compileGLObjects(*info.getState());
    for (osg::Drawable* drawable : visitor._drawables) drawable->compileGLObjects(info);
}

/// The shaders and programs of the current context.
std::size_t countPrograms(const osg::GLExtensions& gl) {
    std::size_t count = 0;
    for (GLuint name = 1; name < 2000; ++name) count += gl.glIsProgram(name) == GL_TRUE ? 1 : 0;
    return count;
}

class GpuCompile : public testing::TestWithParam<void (*)(osg::Node&, osg::RenderInfo&)> {
protected:
    /// Compiles a scene, and draws it in one frame.
    void run(osg::Node* scene) {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        GpuStage stage(root);
        stage.setSphere(scene->getBound());
        stage.look({0.4, -1.0, 0.6}, 2.2);
        stage.draw();
        osg::GraphicsContext& context = *stage.viewer.getView(0)->getCamera()->getGraphicsContext();
        ASSERT_TRUE(context.makeCurrent());
        const osg::GLExtensions& gl = *context.getState()->get<osg::GLExtensions>();
        osg::RenderInfo info(context.getState(), nullptr);
        const std::size_t before = countPrograms(gl);
        GetParam()(*scene, info);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        // Display lists that are compiled next read the processor's memory.
        context.getState()->unbindVertexBufferObject();
        GLint bound = -1;
        glGetIntegerv(GL_ARRAY_BUFFER_BINDING_ARB, &bound);
        EXPECT_EQ(bound, 0) << "left bound, without osg::State";
        compiled = countPrograms(gl);
        EXPECT_GT(compiled, before);
        root->addChild(scene);
        stage.frame(0.1);
        ASSERT_TRUE(context.makeCurrent());
        drawn = countPrograms(gl);
        seen = test::seenPixels(stage.picture());
        root->removeChild(scene);
        scene->releaseGLObjects(context.getState());
        context.releaseContext();
    }
    std::size_t compiled = 0, drawn = 0, seen = 0;
};

TEST_P(GpuCompile, CompilesSkinsBeforeTheirFirstFrame) {
    for (const char* subject : {"tube", "morphs"}) {
        test::GpuSubject skins(subject);
        osgSkin::setGpu(*skins.scene, true);
        const unsigned int dispatches = osgSkin::gpuCounts().dispatches;
        run(skins.scene);
        EXPECT_EQ(drawn, compiled) << subject;
        EXPECT_GT(seen, 1000u) << subject;
        EXPECT_GT(osgSkin::gpuCounts().dispatches, dispatches) << "by the processor";
    }
}

TEST_P(GpuCompile, CompilesCrowdsBeforeTheirFirstFrame) {
    const test::CrowdSubject subject(16);
    const osg::ref_ptr<osgSkin::CrowdCharacter> character = subject.character();
    character->addUsualLevels();
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(character);
    crowd->setInstances(subject.members);
    run(crowd);
    EXPECT_EQ(drawn, compiled);
    EXPECT_GT(seen, 1000u);
}

TEST_P(GpuCompile, CompilesCrowdsWithAProgramAboveThem) {
    const test::CrowdSubject subject(16);
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(subject.character());
    crowd->setInstances(subject.members);
    const osg::ref_ptr<osg::Group> above = new osg::Group;
    above->addChild(crowd);
    above->getOrCreateStateSet()->setAttribute(
        test::CrowdSubject::program(), osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    run(above);
    EXPECT_EQ(drawn, compiled);
    EXPECT_GT(seen, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Visitors, GpuCompile, testing::Values(visit, collect));

} // namespace
