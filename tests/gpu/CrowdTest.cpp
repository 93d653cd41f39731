// SPDX-License-Identifier: MIT
// Crowds beside skins that the processor deforms, and the ways to draw a crowd beside each other.
#include "CrowdPicture.h"
#include "Pixels.h"

#include <gtest/gtest.h>

#include <osg/TextureBuffer>
#include <osgUtil/RenderBin>

#include <chrono>
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

/// What draw threads are given to draw.
std::size_t leavesOf(const osgUtil::RenderBin& bin) {
    std::size_t leaves = bin.getRenderLeafList().size();
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        leaves += graph->_leaves.size();
    for (const auto& [number, child] : const_cast<osgUtil::RenderBin&>(bin).getRenderBinList())
        leaves += leavesOf(*child);
    return leaves;
}

/// What a frame makes the processor do for so many members, told without a clock: what it gives to
/// the draw, and how often it writes what is uploaded.
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

TEST_F(Crowd, IsThePictureOfItsSkins) {
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

TEST_F(Crowd, PalettesClipsAndCommandsGiveOnePicture) {
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
    // A clip mixed with itself is that clip, though joints are then multiplied out by the shader.
    for (CrowdInstance& member : blended) member.otherClip = member.clip;
    EXPECT_LE(test::unlikePixels(*withBlend(0.5f), *one), 20u);
}

TEST_F(Crowd, TheCardAndTheProcessorChooseTheSameLevels) {
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

TEST_F(Crowd, TenThousandMembersTakeNoTimeOfTheProcessor) {
    const CrowdSubject many(10000);
    CrowdSubject few(2);
    const auto character = few.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, many.members);
    // Half of the circle is behind the camera: what is drawn does not count here.
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

TEST_F(Crowd, TheProcessorsWorkDoesNotGrowWithTheMembers) {
    const auto character = subject.character();
    character->addLevel(0.4, 0.2);
    const auto few = workOfAFrame(character, 10);
    EXPECT_GT(few.first, 0u);
    EXPECT_EQ(few.second, 0u);
    EXPECT_EQ(workOfAFrame(character, 1000), few);
}
