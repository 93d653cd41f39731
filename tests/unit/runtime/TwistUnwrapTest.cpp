// SPDX-License-Identifier: MIT
// A twist that runs through 180 degrees: it flips unless UpdateDeformableSkin is told otherwise.
#include "TubeSkin.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

namespace {

const double kDegree = osg::PI / 180.0;

class TwistUnwrap : public testing::Test {
protected:
    TwistUnwrap() {
        skin->setUpdateCallback(callback);
        skeleton->addChild(skin);
    }

    /// The middle joint's twist, in degrees, after an update at `time` with its bone turned.
    double twistAt(double time, double degrees) {
        auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
        auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
        auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
        middle.setMatrixInSkeletonSpace(
            osg::Matrix::rotate(degrees * kDegree, osg::Vec3d(0, 1, 0)) *
            osg::Matrix::translate(0, 2, 0));
        end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) *
                                     middle.getMatrixInSkeletonSpace());
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        osgUtil::UpdateVisitor update;
        update.setFrameStamp(stamp);
        skeleton->accept(update);
        return skin->getPose().transform(1).split.twistAngle / kDegree;
    }

    osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<osgSkin::UpdateDeformableSkin> callback = new osgSkin::UpdateDeformableSkin;
};

} // namespace

TEST_F(TwistUnwrap, OffByDefault) {
    EXPECT_FALSE(callback->getUnwrapTwist());
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), -170.0, 1e-9);
}

TEST_F(TwistUnwrap, RunsOnThroughHalfATurnAndBack) {
    callback->setUnwrapTwist(true);
    double time = 0.0;
    for (double degrees = 0.0; degrees <= 350.0; degrees += 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
    for (double degrees = 350.0; degrees >= -350.0; degrees -= 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
}

TEST_F(TwistUnwrap, SkinRunsOnToo) {
    callback->setUnwrapTwist(true);
    double time = 0.0;
    for (double degrees = 0.0; degrees <= 350.0; degrees += 10.0) {
        twistAt(time += 0.05, degrees);
        // Halfway up the middle joint's region half of the twist is taken, of what is left over
        // 2 pi too. The ring of vertices at the joint has ratio one half.
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        const osg::Vec3 at = vertices[std::size_t(8) * 12]; // height 2, at angle 0
        const double half = 0.5 * degrees * kDegree;
        ASSERT_NEAR(at.x(), std::cos(half), 1e-5) << degrees;
        ASSERT_NEAR(at.z(), -std::sin(half), 1e-5) << degrees;
    }
}

TEST_F(TwistUnwrap, StartsAfreshOnASeek) {
    callback->setUnwrapTwist(true);
    double time = 1.0;
    const auto wind = [&] {
        for (double degrees = 100.0; degrees <= 200.0; degrees += 20.0)
            twistAt(time += 0.05, degrees);
        EXPECT_NEAR(skin->getPose().transform(1).split.twistAngle / kDegree, 200.0, 1e-9);
    };
    wind();
    EXPECT_NEAR(twistAt(time += 1.0, 200.1), -159.9, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time -= 1.0, 200.1), -159.9, 1e-9);
    wind();
    callback->startTwistAfresh();
    EXPECT_NEAR(twistAt(time += 0.01, 200.0), -160.0, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time += 0.05, 20.0), 20.0, 1e-9); // too far to be one motion
    wind();
    callback->setUnwrapTwist(false);
    twistAt(time += 0.05, 200.0);
    EXPECT_NEAR(twistAt(time += 0.05, 200.1), -159.9, 1e-9);
}
