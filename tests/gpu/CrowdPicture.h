// SPDX-License-Identifier: MIT
#pragma once

#include "CrowdSubject.h"
#include "GpuStage.h"
#include "Pixels.h"

#include <gtest/gtest.h>

#include <vector>

namespace test {

/// Pictures of crowds, each in a context of its own; the drawn scene's GL objects are released
/// again.
class CrowdTest : public testing::Test {
protected:
    static osg::ref_ptr<osgSkin::GpuCrowd>
    crowdOf(osgSkin::CrowdCharacter* character, const std::vector<osgSkin::CrowdInstance>& members,
            double time = kTime) {
        osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(character);
        crowd->setInstances(members);
        crowd->setTime(time);
        return crowd;
    }

    static osg::ref_ptr<osg::Image>
    pictureOf(osg::Node* scene, double distance = 2.2,
              osg::CullSettings::ComputeNearFarMode mode =
                  osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES) {
        GpuStage stage(scene);
        // The crowd and the separate skins compute their bounds differently.
        stage.setSphere({{7.5, 7.5, 2.0}, 13.0});
        stage.look({0.4, -1.0, 0.6}, distance);
        stage.viewer.getView(0)->getCamera()->setComputeNearFarMode(mode);
        stage.draw();
        osg::ref_ptr<osg::Image> picture =
            new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
        scene->releaseGLObjects(nullptr);
        return picture;
    }

    /// Both culling methods; each picture is drawn with both.
    static constexpr osgSkin::GpuCrowd::Culling kCullings[] = {
        osgSkin::GpuCrowd::Culling::Automatic, osgSkin::GpuCrowd::Culling::Processor};

    CrowdSubject subject{16};

public:
    static constexpr double kTime = 0.3;
};

} // namespace test
