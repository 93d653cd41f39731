// SPDX-License-Identifier: MIT
//
// Crowds compared with skins deformed on the CPU, and the culling methods compared with each other.
//
// Invalid input, which leaves a crowd's character and members unchanged.
//
// Crowds larger than a driver's buffers or than one dispatch covers.
#include "CrowdPicture.h"
#include "CrowdSubject.h"
#include "Notices.h"
#include "Pixels.h"
#include "TubeSkin.h"
#include "crowd/CrowdDraws.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/Shape>
#include <osg/ShapeDrawable>
#include <osg/TextureBuffer>
#include <osgUtil/RenderBin>

#include <chrono>
#include <limits>
#include <utility>

namespace {

using osgSkin::CrowdCharacter;
using osgSkin::CrowdInstance;
using osgSkin::GpuCrowd;
using test::CrowdSubject;
using test::GpuStage;
using Crowd = test::CrowdTest;

static_assert(CrowdInstance::kTexels * sizeof(osg::Vec4ui) <= 64, "memory of an instance");

constexpr double kTime = test::CrowdTest::kTime;

osg::ref_ptr<osg::Group> inProgram(osg::Node* node) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);
    root->getOrCreateStateSet()->setAttribute(
        CrowdSubject::program(), osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    return root;
}

/// Number of leaves that draw threads draw.
std::size_t leavesOf(const osgUtil::RenderBin& bin) {
    std::size_t leaves = bin.getRenderLeafList().size();
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        leaves += graph->_leaves.size();
    for (const auto& [number, child] : const_cast<osgUtil::RenderBin&>(bin).getRenderBinList())
        leaves += leavesOf(*child);
    return leaves;
}

/// CPU work of a frame for a number of members, counted rather than timed: leaves to draw, and how
/// often uploaded data is written.
std::pair<std::size_t, unsigned int> workOfAFrame(CrowdCharacter* character, std::size_t count) {
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    crowd->setInstances(CrowdSubject(count).members);
    GpuStage stage(crowd);
    stage.lookAway();
    stage.frame(0.0);
    const auto written = [&] {
        unsigned int sum = 0;
        for (const auto& unit : crowd->getStateSet()->getTextureAttributeList())
            for (const auto& [type, attribute] : unit)
                if (auto* texels = dynamic_cast<osg::TextureBuffer*>(attribute.first.get()))
                    sum += texels->getBufferData()->getModifiedCount();
        return sum;
    };
    const unsigned int before = written();
    const osg::ref_ptr<osgUtil::CullVisitor> cv = stage.cullVisitor();
    crowd->setTime(0.01);
    crowd->traverse(*cv);
    const std::size_t leaves = leavesOf(*cv->getCurrentRenderBin()->getStage());
    crowd->releaseGLObjects(nullptr);
    return {leaves, written() - before};
}

} // namespace

TEST_F(Crowd, MatchesPictureOfItsSkins) {
    const auto expected = pictureOf(inProgram(subject.skins(kTime)));
    const auto other = pictureOf(inProgram(subject.skins(0.0)));
    const auto character = subject.character();
    const auto is = pictureOf(inProgram(crowdOf(character, subject.members)));
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    EXPECT_GT(test::unlikePixels(*other, *expected), 1000u) << "another pose would be seen";
    const unsigned int unlike = test::unlikePixels(*is, *expected);
    EXPECT_LE(unlike, GpuStage::kSize * GpuStage::kSize * 2 / 10000);
    std::cout << "crowd: " << unlike << " pixels of " << GpuStage::kSize * GpuStage::kSize
              << std::endl;
}

/// A crowd that has gone before its window closes leaves nothing behind that a crowd in the next
/// window, whose context has the same number, would take for its own.
TEST_F(Crowd, DrawsInASecondWindow) {
    osg::ref_ptr<osg::Image> pictures[2];
    for (osg::ref_ptr<osg::Image>& picture : pictures) {
        osg::ref_ptr<osg::Node> crowd = crowdOf(subject.character(), subject.members);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(crowd);
        GpuStage stage(scene);
        stage.draw();
        picture = new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
        scene->removeChild(crowd);
        crowd = nullptr;
        stage.draw();
    }
    EXPECT_GT(test::seenPixels(*pictures[0]), 3000u);
    EXPECT_EQ(test::unlikePixels(*pictures[0], *pictures[1]), 0u);
}

TEST_F(Crowd, PalettesClipsAndCommandsGiveTheSamePicture) {
    const auto character = subject.character(kTime);
    const osg::ref_ptr<GpuCrowd> indirect = crowdOf(character, subject.members);
    const auto expected = pictureOf(indirect);
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    indirect->setCulling(GpuCrowd::Culling::Processor);
    EXPECT_EQ(test::unlikePixels(*pictureOf(indirect), *expected), 0u) << "clips";
    const osg::ref_ptr<GpuCrowd> palettes = crowdOf(character, subject.posedMembers());
    EXPECT_EQ(test::unlikePixels(*pictureOf(palettes), *expected), 0u) << "palettes, commands";
    palettes->setCulling(GpuCrowd::Culling::Processor);
    EXPECT_EQ(test::unlikePixels(*pictureOf(palettes), *expected), 0u) << "palettes";
}

/// Such as a program for normal maps, which draws other figures.
TEST_F(Crowd, ReplacesProgramsThatDrawNoMembers) {
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                       "void main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }"));
    const auto picture = [&] {
        return pictureOf(crowdOf(subject.character(0.0, state), subject.members));
    };
    const auto plain = picture();
    EXPECT_GT(test::seenPixels(*plain), 10000u);
    state->setAttribute(program);
    EXPECT_EQ(test::unlikePixels(*picture(), *plain), 0u);
    EXPECT_NE(state->getAttribute(osg::StateAttribute::PROGRAM), nullptr) << "it is the author's";
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT, "// osgSkin_vertex\nvoid main() { discard; }"));
    EXPECT_GT(test::unlikePixels(*picture(), *plain), 100u) << "a program for crowds";
}

TEST_F(Crowd, BlendsTwoClips) {
    const auto character = subject.character();
    std::vector<CrowdInstance> others = subject.members, blended = subject.members;
    for (std::size_t i = 0; i < others.size(); ++i) {
        others[i].clip = 1 - others[i].clip;
        blended[i].otherClip = others[i].clip;
        blended[i].otherPhase = blended[i].phase;
    }
    const auto one = pictureOf(crowdOf(character, subject.members));
    const auto other = pictureOf(crowdOf(character, others));
    const auto withBlend = [&](float blend) {
        for (CrowdInstance& member : blended) member.blend = blend;
        return pictureOf(crowdOf(character, blended));
    };
    EXPECT_EQ(test::unlikePixels(*withBlend(0.0f), *one), 0u);
    EXPECT_LE(test::unlikePixels(*withBlend(1.0f), *other), 20u);
    const auto half = withBlend(0.5f);
    EXPECT_GT(test::unlikePixels(*half, *one), 500u);
    EXPECT_GT(test::unlikePixels(*half, *other), 500u);
    // A clip mixed with itself is that clip, but the shader then multiplies joint transforms.
    for (CrowdInstance& member : blended) member.otherClip = member.clip;
    EXPECT_LE(test::unlikePixels(*withBlend(0.5f), *one), 20u);
}

TEST_F(Crowd, GpuAndCpuChooseTheSameLevels) {
    const auto character = subject.character();
    const std::size_t all = character->triangleCount(0);
    const std::size_t fewer = character->addLevel(0.4, 0.2);
    EXPECT_LT(fewer, all * 6 / 10);
    EXPECT_GT(fewer, all / 5);
    character->addLevel(0.15, 0.1);
    EXPECT_EQ(character->levelCount(), 3u);
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    for (const double distance : {1.0, 2.5, 8.0}) { // some out of view; all three levels
        crowd->setCulling(GpuCrowd::Culling::Automatic);
        const auto card = pictureOf(crowd, distance);
        crowd->setCulling(GpuCrowd::Culling::Processor);
        EXPECT_EQ(test::unlikePixels(*pictureOf(crowd, distance), *card), 0u) << distance;
        EXPECT_GT(test::seenPixels(*card), 300u);
    }
}

TEST_F(Crowd, TenThousandMembersNeedLittleCpuTime) {
    const CrowdSubject many(10000);
    CrowdSubject few(2);
    const auto character = few.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, many.members);
    // Half of the circle is behind the camera; drawing is not measured here.
    GpuStage stage(crowd);
    stage.lookAway();
    stage.frame(0.0);
    osg::ref_ptr<osgUtil::CullVisitor> cv;
    double best = 1e9;
    for (int i = 0; i < 20; ++i) {
        cv = stage.cullVisitor();
        const auto start = std::chrono::steady_clock::now();
        crowd->setTime(0.01 * i);
        crowd->traverse(*cv);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count());
    }
    EXPECT_GT(cv->getCurrentRenderBin()->getStage()->getRenderBinList().size(), 0u) << "drawn";
    EXPECT_LE(best, 0.1) << "milliseconds";
    std::cout << "10,000 members: " << 1000.0 * best << " us a frame" << std::endl;
    crowd->releaseGLObjects(nullptr);
}

TEST_F(Crowd, CpuTimeDoesNotGrowWithMembers) {
    const auto character = subject.character();
    character->addLevel(0.4, 0.2);
    const auto few = workOfAFrame(character, 10);
    EXPECT_GT(few.first, 0u);
    EXPECT_EQ(few.second, 0u);
    EXPECT_EQ(workOfAFrame(character, 1000), few);
}

namespace {

using osgSkin::CrowdCharacter;
using osgSkin::CrowdInstance;
using osgSkin::Error;
using osgSkin::GpuCrowd;
using test::CrowdSubject;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A tube with palettes of more than 800 texels.
osg::ref_ptr<osgSkin::DeformableSkin> skinOfLargePalettes() {
    test::Tube tube;
    osgSkin::Correctives& correctives = tube.binding.correctives;
    osgSkin::CorrectiveJoint breath;
    breath.basis = osgSkin::CorrectiveJoint::Basis::Input;
    breath.low.x = -1.0;
    breath.high.x = 1.0;
    breath.modes = osgSkin::CorrectiveJoint::kMaxModes;
    breath.coefficients.assign(breath.modes, 0.1);
    correctives.inputs = {"breath"};
    correctives.joints.assign(osgSkin::Correctives::kMaxJoints, breath);
    correctives.firstEntry.assign(tube.positions.size() + 1, 1);
    correctives.firstEntry.front() = 0;
    correctives.entries = {{0, 0}};
    correctives.shares.assign(3 * breath.modes, 1);
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(test::makeGeometry(tube), tube.model());
    return skin;
}

osg::PrimitiveSet* triangles(const std::vector<GLuint>& corners) {
    return new osg::DrawElementsUInt(GL_TRIANGLES, corners.begin(), corners.end());
}

CrowdCharacter::Samples restSamples(std::size_t count) {
    return {
        std::vector<std::vector<glm::dmat4>>(count, std::vector<glm::dmat4>(3, glm::dmat4(1.0)))};
}

} // namespace

TEST(CrowdCharacter, RejectsInvalidInput) {
    const CrowdSubject subject(1);
    EXPECT_THROW(osg::ref_ptr<GpuCrowd>(new GpuCrowd(new CrowdCharacter)), Error);
    const osg::ref_ptr<osg::Geometry> nothing = new osg::Geometry;
    const auto character = subject.character();
    EXPECT_THROW(character->addClip({}, 30.0, true), Error);
    EXPECT_THROW(character->addClip({{{}}}, 30.0, true), Error);
    EXPECT_FALSE(character->setSample(7, 0, 0, osgSkin::Pose()));
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 0, "end"), Error);
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 0, "tail"), Error);
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 9, "end"), Error);
}

TEST(CrowdCharacter, ForgetsRejectedClips) {
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    character->addSkin(*skinOfLargePalettes(), osg::Matrixd());
    EXPECT_THROW(character->addClip(restSamples(25000), 30.0, true), Error) << "texels";
    EXPECT_THROW(osg::ref_ptr<GpuCrowd>(new GpuCrowd(character)), Error) << "it has no clip";
    auto far = restSamples(2);
    far[0][0][0][3].x = 1000.0;
    far[0][1][1][0].x = kNaN;
    EXPECT_THROW(character->addClip(far, 30.0, true), Error);
    EXPECT_FALSE(character->bounds().valid());
    EXPECT_EQ(character->addClip(restSamples(2), 30.0, true), 0u);
    EXPECT_EQ(character->clipCount(), 1u);
    EXPECT_LT(character->bounds().xMax(), 100.0f);
}

TEST(CrowdCharacter, RejectsRatesThatShadersLack) {
    const auto character = CrowdSubject(1).character();
    for (const double rate : {0.0, -1.0, kNaN, kInf, 1e39, 1e-46})
        EXPECT_THROW(character->addClip(restSamples(2), rate, true), Error) << rate;
    EXPECT_EQ(character->clipCount(), 3u);
    EXPECT_DOUBLE_EQ(character->loopSeconds(0), 0.8);
    EXPECT_EQ(character->loopSeconds(2), 0.0);
}

TEST(CrowdCharacter, LevelsGrowCoarserOneByOne) {
    const auto character = CrowdSubject(1).character();
    for (const double wrong : {-0.1, 1.0, 2.0, kNaN, kInf, -kInf})
        EXPECT_THROW(character->addLevel(wrong, 0.5), Error) << wrong;
    for (const double wrong : {-0.1, kNaN, kInf, 1e39})
        EXPECT_THROW(character->addLevel(0.5, wrong), Error) << wrong;
    EXPECT_EQ(character->levelCount(), 1u);
    character->addLevel(0.5, 0.5);
    EXPECT_THROW(character->addLevel(0.5, 0.1), Error);
    EXPECT_THROW(character->addLevel(0.1, 0.5), Error);
    EXPECT_EQ(character->levelCount(), 2u);
    // With levels, a skin without triangles is refused.
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd()), Error);
    EXPECT_EQ(character->skins().size(), 1u);
}

/// A geometry with a vertex for each corner of its triangles, and their normals.
TEST(CrowdCharacter, LevelsGrowCoarserAcrossHardEdges) {
    CrowdSubject subject(1);
    osg::Geometry& knob = subject.knob();
    const auto& positions = static_cast<const osg::Vec3Array&>(*knob.getVertexArray());
    const osg::PrimitiveSet& primitives = *knob.getPrimitiveSet(0);
    ASSERT_EQ(primitives.getMode(), GLenum(GL_TRIANGLES));
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    for (unsigned int i = 0; i < primitives.getNumIndices(); i += 3) {
        for (unsigned int k = i; k < i + 3; ++k) corners->push_back(positions[primitives.index(k)]);
        osg::Vec3 normal =
            ((*corners)[i + 1] - (*corners)[i]) ^ ((*corners)[i + 2] - (*corners)[i]);
        normal.normalize();
        normals->resize(corners->size(), normal);
    }
    const osg::ref_ptr<osg::Geometry> flat = new osg::Geometry;
    flat->setVertexArray(corners);
    flat->setNormalArray(normals);
    flat->addPrimitiveSet(
        new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners->size())));
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    character->addSkin(*test::makeSkin(), osg::Matrixd());
    character->addRigid(*flat, nullptr, 0, "end");
    const std::size_t all = character->triangleCount(0);
    ASSERT_GE(all, 100u);
    EXPECT_LE(character->addLevel(0.3, 0.2), all / 2);
    // Its triangles have normals of their own sides.
    const std::vector<GLuint>& kept = character->parts()[1].indices[1];
    ASSERT_FALSE(kept.empty());
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        const osg::Vec3 normal = ((*corners)[kept[i + 1]] - (*corners)[kept[i]]) ^
                                 ((*corners)[kept[i + 2]] - (*corners)[kept[i]]);
        for (std::size_t k = i; k < i + 3; ++k) EXPECT_GE((*normals)[kept[k]] * normal, 0.0f);
    }
}

TEST(CrowdCharacter, RejectsTrianglesWithMissingVertices) {
    const CrowdSubject subject(1);
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    for (const GLuint beyond : {72u, 4000000000u}) {
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
        const osg::ref_ptr<osg::Geometry> rest =
            new osg::Geometry(*skin->getRestGeometry(), osg::CopyOp::SHALLOW_COPY);
        const GLuint last = beyond == 72u ? rest->getVertexArray()->getNumElements() : beyond;
        skin->setSkin(rest, skin->getModel());
        rest->addPrimitiveSet(triangles({0, 1, last}));
        EXPECT_THROW(character->addSkin(*skin, osg::Matrixd()), Error);
    }
    const std::size_t skin = character->addSkin(*test::makeSkin(), osg::Matrixd());
    EXPECT_EQ(skin, 0u) << "what was refused is not kept";
    subject.knob().setPrimitiveSet(0, triangles({0, 1, 2, 3}));
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, skin, "end"), Error);
    subject.knob().setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3000000));
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, skin, "end"), Error);
    EXPECT_EQ(character->parts().size(), 1u);
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd::scale(1, 0, 1)), Error);
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd::scale(1, kNaN, 1)), Error);
}

TEST(CrowdCharacter, WarnsOnceAboutMorphs) {
    osgSkin::MorphTarget smile;
    smile.name = "smile";
    smile.vertices = {3};
    smile.positions = {glm::vec3(0.5f, 0.0f, 0.0f)};
    const osg::ref_ptr<osgSkin::DeformableSkin> face = test::makeSkin();
    face->setMorphTargets(osgSkin::MorphTargets::create({smile}, face->getModel()->vertexCount()));
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    const test::Notices notices;
    character->addSkin(*face, osg::Matrixd());
    character->addSkin(*face, osg::Matrixd());
    EXPECT_TRUE(notices.say("has morph targets, which members are drawn without"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

TEST(CrowdCharacter, CannotChangeOnceACrowdUsesIt) {
    const CrowdSubject subject(2);
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    EXPECT_THROW(character->addClip(restSamples(2), 30.0, true), Error);
    EXPECT_THROW(character->addLevel(0.5, 0.5), Error);
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, 0, "end"), Error);
}

TEST(GpuCrowd, RejectsInvalidMembers) {
    const CrowdSubject subject(2);
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    crowd->setInstances(subject.members);
    const osg::BoundingSphere before = crowd->getBound();
    const auto refuses = [&](void (*spoil)(CrowdInstance&)) {
        std::vector<CrowdInstance> members(3, subject.members.front());
        spoil(members[2]);
        EXPECT_THROW(crowd->setInstances(members), Error);
    };
    refuses([](CrowdInstance& one) { one.clip = 3; });
    refuses([](CrowdInstance& one) { one.otherClip = 65536, one.blend = 0.5f; });
    refuses([](CrowdInstance& one) { one.blend = 1.5f; });
    refuses([](CrowdInstance& one) { one.blend = std::numeric_limits<float>::quiet_NaN(); });
    refuses([](CrowdInstance& one) { one.position.x() = 1e39; });
    refuses([](CrowdInstance& one) { one.rotation.y() = kNaN; });
    refuses([](CrowdInstance& one) { one.position.z() = -2e18; });
    refuses([](CrowdInstance& one) { one.scale = 1e38f; });
    refuses([](CrowdInstance& one) { one.rotation *= 1e10; });
    refuses([](CrowdInstance& one) { one.phase = kInf; });
    refuses([](CrowdInstance& one) { one.scale = std::numeric_limits<float>::infinity(); });
    refuses([](CrowdInstance& one) { one.colour.a() = std::numeric_limits<float>::quiet_NaN(); });
    EXPECT_EQ(crowd->getInstanceCount(), 2u);
    EXPECT_EQ(crowd->getBound(), before);
}

namespace {

using osgSkin::CrowdInstance;
using osgSkin::TexelCheck;
using test::GpuStage;
using CrowdLimits = test::CrowdTest;

/// Draws a drawable and counts how often.
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

TEST_F(CrowdLimits, DoesNotDrawBuffersTooLargeForTheDriver) {
    EXPECT_GT(seenOf(new TexelCheck(65536, nullptr)), 1000u) << "what OpenGL promises";
    EXPECT_EQ(seenOf(new TexelCheck(std::numeric_limits<std::size_t>::max(), nullptr)), 0u);
}

TEST_F(CrowdLimits, UsesDrawCallbacksOfDrawables) {
    const osg::ref_ptr<CountedDraw> own = new CountedDraw;
    EXPECT_GT(seenOf(new TexelCheck(1, own)), 1000u);
    EXPECT_GT(own->count, 0);
}

TEST_F(CrowdLimits, DrawsMoreMembersThanOneDispatchCulls) {
    constexpr std::size_t kMax = std::size_t{65535} * 64;
    const auto character = subject.character();
    CrowdInstance away = subject.members.front();
    away.position += osg::Vec3d(0.0, 0.0, 1e6);
    std::vector<CrowdInstance> members(kMax + 1, away);
    members.back() = subject.members.front();
    const auto alone = pictureOf(crowdOf(character, {subject.members.front()}));
    EXPECT_GT(test::seenPixels(*alone), 50u);
    EXPECT_EQ(test::unlikePixels(*pictureOf(crowdOf(character, members)), *alone), 0u);
}
