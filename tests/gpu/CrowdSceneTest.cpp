// SPDX-License-Identifier: MIT
//
// Crowds in scenes that show them more than once, for a long time, or with their own states.
#include "CrowdPicture.h"
#include "Pixels.h"

#include <osgSkin/GlmOsg>

#include <gtest/gtest.h>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgUtil/RenderBin>

#include <limits>
#include <set>

namespace {

using osgSkin::CrowdCharacter;
using osgSkin::CrowdInstance;
using osgSkin::GpuCrowd;
using test::GpuStage;
using CrowdScene = test::CrowdTest;

void addLeaves(osgUtil::RenderBin& bin, std::set<const osg::Drawable*>& drawables) {
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        for (const auto& leaf : graph->_leaves) drawables.insert(leaf->getDrawable());
    for (const auto& [number, child] : bin.getRenderBinList()) addLeaves(*child, drawables);
}

osg::ref_ptr<osg::Group> moved(osg::Node* node, const osg::Vec3d& way) {
    osg::ref_ptr<osg::MatrixTransform> result =
        new osg::MatrixTransform(osg::Matrixd::translate(way));
    result->addChild(node);
    return result;
}

/// A CPU-culled crowd, on a stage that has drawn once and then turned the camera away.
class CulledCrowd : public test::CrowdTest {
protected:
    const osg::ref_ptr<CrowdCharacter> character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    GpuStage stage{crowd};

    CulledCrowd() {
        crowd->setCulling(GpuCrowd::Culling::Processor);
        stage.lookAway();
        stage.frame(0.0);
    }
    ~CulledCrowd() override { crowd->releaseGLObjects(nullptr); }
};

} // namespace

TEST_F(CulledCrowd, DoesNotGrowInMemory) {
    std::set<const osg::Drawable*> drawables;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    for (unsigned int i = 0; i < 300; ++i) {
        const osg::ref_ptr<osgUtil::CullVisitor> cv = stage.cullVisitor();
        // First without a frame stamp, then with frame numbers that restart.
        if (i >= 100) cv->setFrameStamp(stamp);
        stamp->setFrameNumber(i < 200 ? 1000 + i : i - 200);
        crowd->traverse(*cv);
        addLeaves(*cv->getCurrentRenderBin()->getStage(), drawables);
    }
    EXPECT_GT(drawables.size(), 0u);
    EXPECT_LE(drawables.size(), 3 * character->parts().size());
}

TEST_F(CulledCrowd, DoesNotCullAgainBeforeItsDraw) {
    const osg::ref_ptr<osgUtil::CullVisitor> one = stage.cullVisitor(), other = stage.cullVisitor();
    crowd->traverse(*one);
    crowd->traverse(*other);
    std::set<const osg::Drawable*> ofOne, ofOther;
    addLeaves(*one->getCurrentRenderBin()->getStage(), ofOne);
    addLeaves(*other->getCurrentRenderBin()->getStage(), ofOther);
    EXPECT_GT(ofOne.size(), 0u);
    for (const osg::Drawable* drawable : ofOther) EXPECT_EQ(ofOne.count(drawable), 0u);
}

TEST_F(CrowdScene, TwoParentsMatchTwoCrowds) {
    const auto character = subject.character();
    const osg::Vec3d aside(9.0, 2.0, 0.0), back(-6.0, 7.0, 1.0);
    const osg::ref_ptr<GpuCrowd> one = crowdOf(character, subject.members);
    const osg::ref_ptr<GpuCrowd> other = crowdOf(character, subject.members);
    const osg::ref_ptr<osg::Group> two = new osg::Group, shared = new osg::Group;
    two->addChild(moved(one, aside));
    two->addChild(moved(other, back));
    shared->addChild(moved(one, aside));
    shared->addChild(moved(one, back));
    const auto expected = pictureOf(two, 1.2); // some out of view of each
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    for (const GpuCrowd::Culling culling : kCullings) {
        one->setCulling(culling);
        EXPECT_EQ(test::unlikePixels(*pictureOf(shared, 1.2), *expected), 0u);
    }
}

TEST_F(CrowdScene, PlaysAfterYears) {
    const auto character = subject.character();
    const auto expected = pictureOf(crowdOf(character, subject.members));
    // Whole loops of the clips, of 0.8 s.
    for (const double before : {0.8 * 126000, -0.8 * 126000, 0.8 * 40e6}) {
        const auto late = pictureOf(crowdOf(character, subject.members, kTime + before));
        EXPECT_LE(test::unlikePixels(*late, *expected), 20u) << before << " s";
        // Clips that begin now.
        std::vector<CrowdInstance> begun = subject.members;
        for (CrowdInstance& member : begun) member.phase -= before;
        const auto now = pictureOf(crowdOf(character, begun, kTime + before));
        EXPECT_LE(test::unlikePixels(*now, *expected), 20u) << before << " s";
    }
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    crowd->setTime(std::numeric_limits<double>::infinity());
    crowd->setTime(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(test::unlikePixels(*pictureOf(crowd), *expected), 0u);
}

TEST_F(CrowdScene, GrowsBoundsWithSamples) {
    std::vector<CrowdInstance> members = subject.posedMembers();
    for (CrowdInstance& member : members) {
        member.rotation = osg::Quat();
        member.scale = 1.0f;
    }
    const glm::dvec3 aside(20.0, 0.0, 0.0);
    // All figures move out of view; then the crowd moves back.
    const auto standing = subject.character(), gone = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(gone, members);
    EXPECT_FALSE(crowd->getBound().contains(members.back().position + osgSkin::toOsg(aside)));
    const std::vector<osgSkin::BoundJoint>& joints = gone->skins()[0].model->model().joints();
    osgSkin::Pose pose(joints), rest(joints);
    const std::vector<glm::dmat4> skinning(joints.size(), glm::translate(glm::dmat4(1.0), aside));
    ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
    for (std::size_t i = 0; i < members.size(); ++i) {
        ASSERT_TRUE(standing->setSample(2, i, 0, rest));
        ASSERT_TRUE(gone->setSample(2, i, 0, pose));
    }
    EXPECT_TRUE(crowd->getBound().contains(members.back().position + osgSkin::toOsg(aside)));
    const auto expected = pictureOf(crowdOf(standing, members));
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    for (const GpuCrowd::Culling culling : kCullings) {
        crowd->setCulling(culling);
        const auto is = pictureOf(moved(crowd, osgSkin::toOsg(-aside)));
        EXPECT_LE(test::unlikePixels(*is, *expected), 60u);
    }
}

TEST_F(CrowdScene, IsNotClippedWithNearFarByPrimitives) {
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    const auto expected = pictureOf(crowd);
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    for (const GpuCrowd::Culling culling : kCullings) {
        crowd->setCulling(culling);
        const auto is = pictureOf(crowd, 2.2, osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES);
        EXPECT_EQ(test::unlikePixels(*is, *expected), 0u);
    }
}

TEST_F(CrowdScene, ComputesBeforeDrawsInOtherBins) {
    const auto character = subject.character();
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(crowdOf(character, subject.members));
    const auto expected = pictureOf(root);
    root->getOrCreateStateSet()->setRenderBinDetails(10, "DepthSortedBin",
                                                     osg::StateSet::OVERRIDE_RENDERBIN_DETAILS);
    GpuStage stage(root);
    stage.setSphere({{7.5, 7.5, 2.0}, 13.0});
    stage.look({0.4, -1.0, 0.6}, 2.2);
    stage.draw();
    EXPECT_EQ(test::unlikePixels(stage.picture(), *expected), 0u);
    // The visible set of the previous frame, when most members were out of view, is not reused.
    stage.look({1.0, 0.0, 0.1}, 0.3);
    stage.frame(0.0);
    EXPECT_GT(test::unlikePixels(stage.picture(), *expected), 1000u);
    stage.look({0.4, -1.0, 0.6}, 2.2);
    stage.frame(0.0);
    EXPECT_EQ(test::unlikePixels(stage.picture(), *expected), 0u);
    root->releaseGLObjects(nullptr);
}

TEST_F(CrowdScene, RigidPartsKeepTheirState) {
    const osg::ref_ptr<osg::StateSet> red = new osg::StateSet;
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1));
    red->setAttribute(material);
    const auto plain = pictureOf(crowdOf(subject.character(), subject.members));
    const auto expected = pictureOf(crowdOf(subject.character(0.0, red), subject.members));
    EXPECT_GT(test::unlikePixels(*plain, *expected), 100u);
    subject.knob().setStateSet(red);
    const auto is = pictureOf(crowdOf(subject.character(), subject.members));
    EXPECT_EQ(test::unlikePixels(*is, *expected), 0u);
}

TEST_F(CrowdScene, CopiesAreIndependent) {
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = crowdOf(character, subject.members);
    const auto expected = pictureOf(crowd);
    const osg::ref_ptr<GpuCrowd> copy = osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_ALL);
    ASSERT_TRUE(copy);
    crowd->setTime(0.0);
    crowd->setInstances({});
    EXPECT_EQ(copy->getInstanceCount(), subject.members.size());
    EXPECT_EQ(test::unlikePixels(*pictureOf(copy), *expected), 0u);
}
