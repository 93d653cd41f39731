// SPDX-License-Identifier: GPL-3.0-or-later
//
// Scaled bones: a converted skin compared with osgAnimation's result for the same rig.
#include "RigScene.h"

#include <osgSkinBind/ConvertRigs>

#include <gtest/gtest.h>
#include <osg/FrameStamp>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Channel>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

using namespace osgSkin;
using namespace rigs;

namespace {

osg::Matrixd& localOf(Scene& scene, std::size_t bone) {
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*scene.bones[bone]->getUpdateCallback());
    auto& element =
        static_cast<osgAnimation::StackedMatrixElement&>(*update.getStackedTransforms().front());
    return const_cast<osg::Matrixd&>(element.getMatrix());
}

/// Sets the bones' own matrices: a rotation, then a scale, at the joint.
struct Local {
    osg::Quat turn;
    osg::Vec3d scale{1, 1, 1};
};

void pose(Scene& scene, const std::array<Local, 3>& locals, const std::array<double, 3>& offsets) {
    for (std::size_t b = 0; b < 3; ++b)
        localOf(scene, b) = osg::Matrixd::scale(locals[b].scale) *
                            osg::Matrixd::rotate(locals[b].turn) *
                            osg::Matrixd::translate(0, offsets[b], 0);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.root->accept(visitor);
}

const std::array<double, 3> kOffsets{kHeights[0], kHeights[1] - kHeights[0],
                                     kHeights[2] - kHeights[1]};

/// The same rig twice: one converted, one posed by osgAnimation itself.
struct Pair {
    Scene ours, theirs;
    osg::ref_ptr<osgAnimation::RigGeometry> rig;
    ConvertReport report;

    explicit Pair(Paint paint, const std::function<void(Scene&)>& change = {}) {
        ours.skeleton->addChild(makeRig(paint));
        rig = makeRig(paint);
        theirs.skeleton->addChild(rig);
        if (change)
            for (Scene* scene : {&ours, &theirs}) change(*scene);
        report = convertRigs(*ours.root);
        EXPECT_EQ(report.skins.size(), 1u);
    }

    double difference(const std::array<Local, 3>& locals,
                      const std::array<double, 3>& offsets = kOffsets) {
        for (Scene* scene : {&ours, &theirs}) pose(*scene, locals, offsets);
        // A rig finds its bones in its first update and is deformed in the second.
        pose(theirs, locals, offsets);
        const osg::Geometry& posed = *report.skins.at(0)->getDeformedGeometry();
        const osg::Vec3Array& expected = verticesOf(*rig);
        double worst = 0.0;
        for (std::size_t v = 0; v < verticesOf(posed).size(); ++v)
            worst = std::max(
                worst, double((verticesOf(posed)[v] - expected[sourceOf(posed, v)]).length()));
        const osg::BoundingBox& box = report.skins[0]->getBoundingBox();
        for (const osg::Vec3& v : verticesOf(posed))
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(v[axis] > box._min[axis] - 1e-4f && v[axis] < box._max[axis] + 1e-4f);
        return worst;
    }
};

const std::array<Local, 3> kRest{};
const std::array<Local, 3> kTurned{Local{osg::Quat(0.4, osg::Vec3d(1, 2, 0))},
                                   Local{osg::Quat(0.9, osg::Vec3d(0, 1, 3))},
                                   Local{osg::Quat(-1.2, osg::Vec3d(1, 0, 1))}};

std::array<Local, 3> scaled(std::array<Local, 3> locals, const std::array<double, 3>& by) {
    for (std::size_t b = 0; b < 3; ++b) locals[b].scale = osg::Vec3d(by[b], by[b], by[b]);
    return locals;
}

constexpr double kSize = 6.5; ///< the cylinder's

} // namespace

/// As in FBX files in centimetres: the bones are scaled, also in the bind pose.
TEST(ConvertScale, ScaleInTheBindPoseCancels) {
    const std::array<double, 3> by{100.0, 0.5, 0.02};
    const std::array<double, 3> offsets{kOffsets[0], kOffsets[1] / 100.0, kOffsets[2] / 50.0};
    for (const Paint paint : {Paint(rigid), Paint(blended)}) {
        Pair pair(paint, [&](Scene& scene) {
            double size = 1.0;
            for (std::size_t b = 0; b < 3; ++b) {
                size *= by[b];
                scene.bones[b]->setInvBindMatrixInSkeletonSpace(
                    osg::Matrix::translate(0, -kHeights[b], 0) *
                    osg::Matrix::scale(1.0 / size, 1.0 / size, 1.0 / size));
            }
        });
        EXPECT_TRUE(pair.report.notes.empty());
        EXPECT_LT(pair.difference(scaled(kRest, by), offsets), 1e-6 * kSize);
        if (paint == Paint(rigid)) {
            EXPECT_LT(pair.difference(scaled(kTurned, by), offsets), 1e-6 * kSize);
        }
    }
}

TEST(ConvertScale, FollowsTheScaleOfTheRoot) {
    Pair painted(blended), rigidly(rigid);
    for (const double by : {2.0, 0.01, 30.0}) {
        EXPECT_LT(painted.difference(scaled(kRest, {by, 1, 1})), 1e-6 * kSize * by);
        EXPECT_LT(rigidly.difference(scaled(kTurned, {by, 1, 1})), 2e-6 * kSize * by);
    }
}

/// Animated from frame to frame, every bone separately.
TEST(ConvertScale, FollowsTheScaleOfSingleBones) {
    Pair rigidly(rigid), painted(blended);
    for (int frame = 0; frame < 40; ++frame) {
        const double t = 0.1 * frame;
        const std::array<double, 3> by{1.0 + 0.2 * std::sin(t), 1.0 + 0.5 * std::sin(2.0 * t),
                                       std::exp(std::sin(3.0 * t))};
        EXPECT_LT(rigidly.difference(scaled(kTurned, by)), 1e-5 * kSize) << "frame " << frame;
        EXPECT_LT(rigidly.difference(scaled(kRest, by)), 1e-5 * kSize) << "frame " << frame;
    }
    // One joint per vertex and no rotation: its share of the scale equals that of linear blending.
    EXPECT_LT(painted.difference(scaled(kRest, {1.0, 1.5, 1.0})), 1e-5 * kSize);
    EXPECT_LT(painted.difference(scaled(kRest, {1.0, 1.0, 0.4})), 1e-5 * kSize);
}

TEST(ConvertScale, IgnoresScaleAboveTheSkeleton) {
    Pair pair(rigid, [](Scene& scene) {
        const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(
            osg::Matrix::scale(0.01, 0.01, 0.01) * osg::Matrix::rotate(1.0, osg::Vec3d(1, 0, 0)));
        scene.root->removeChild(scene.skeleton);
        above->addChild(scene.skeleton);
        scene.root->addChild(above);
        scene.skeleton->setMatrix(osg::Matrix::scale(5, 5, 5));
    });
    EXPECT_TRUE(pair.report.notes.empty());
    EXPECT_LT(pair.difference(kRest), 1e-6 * kSize);
    EXPECT_LT(pair.difference(kTurned), 1e-6 * kSize);
}

TEST(ConvertScale, NotesNonUniformScale) {
    Scene scene;
    scene.skeleton->setName("figure");
    scene.skeleton->addChild(makeRig(blended));
    localOf(scene, 1) = osg::Matrixd::scale(1.0, 1.5, 1.0) * osg::Matrixd::translate(0, 2.4, 0);
    const ConvertReport report = convertRigs(*scene.root);
    EXPECT_EQ(report.skins.size(), 1u);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0], "skeleton \"figure\": bone \"bone1\" in the scene and 1 more scaled "
                               "non-uniformly, mirrored or to zero, which skins do not follow");
}

TEST(ConvertScale, NotesNoScaleOfBonesWithoutSkin) {
    Scene scene;
    scene.skeleton->addChild(makeRig([](double height) -> std::array<float, 3> {
        return {height < 3.0 ? 1.0f : 0.0f, height < 3.0 ? 0.0f : 1.0f, 0.0f};
    }));
    localOf(scene, 2) = osg::Matrixd::scale(1.0, 1.5, 1.0) * osg::Matrixd::translate(0, 2.4, 0);
    const ConvertReport report = convertRigs(*scene.root);
    EXPECT_EQ(report.skins.size(), 1u);
    EXPECT_TRUE(report.notes.empty());
}

TEST(ConvertScale, NotesNonUniformScaleInClips) {
    for (const bool even : {true, false}) {
        Scene scene;
        scene.skeleton->addChild(makeRig(blended));
        for (std::size_t b = 0; b < 3; ++b)
            localOf(scene, b) = osg::Matrixd::translate(0, kOffsets[b], 0);
        const osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
        clip->setName("stretch");
        const osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel =
            new osgAnimation::Vec3LinearChannel;
        channel->setName("scale");
        channel->setTargetName("bone2");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        keys->push_back(osgAnimation::Vec3Keyframe(0.0, osg::Vec3(1, 1, 1)));
        keys->push_back(
            osgAnimation::Vec3Keyframe(1.0, even ? osg::Vec3(2, 2, 2) : osg::Vec3(1, 2, 1)));
        clip->addChannel(channel);
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
            new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(clip);
        scene.root->setUpdateCallback(manager);
        const ConvertReport report = convertRigs(*scene.skeleton); // the manager is above it
        EXPECT_EQ(report.skins.size(), 1u);
        ASSERT_EQ(report.notes.size(), even ? 0u : 1u);
        if (!even) {
            EXPECT_NE(
                report.notes[0].find("bone \"bone2\" in the clip \"stretch\" scaled non-uniformly"),
                std::string::npos)
                << report.notes[0];
        }
    }
}
