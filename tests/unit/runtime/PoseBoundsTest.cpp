// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include "Tube.h"
#include "Turns.h"

#include <gtest/gtest.h>

#include <limits>

TEST(PoseBounds, ContainEveryVertexAndStayClose) {
    const test::Tube tube(61, 24);
    const auto model = tube.model();
    osgSkin::Pose pose(model->joints());
    std::vector<glm::vec3> positions(model->vertexCount());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.positionCount = positions.size();

    std::mt19937_64 random(6);
    double worst = 0.0; // volume against the tight box's
    for (int i = 0; i < 300; ++i) {
        // Every other pose is of an animal's joints (90 degrees at most), the others are any.
        const bool natural = i % 2 == 0;
        std::vector<glm::dquat> turns(3);
        for (glm::dquat& turn : turns)
            turn = natural ? glm::angleAxis(0.5 * glm::pi<double>() * (i % 10) / 8.0,
                                            test::randomUnit(random))
                           : test::randomRotation(random);
        const auto skinning = test::skinningFrom(model->joints(), turns, glm::dvec3(i, 2 * i, -i));
        ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
        ASSERT_TRUE(job.run());
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        glm::vec3 low(std::numeric_limits<float>::max());
        glm::vec3 high(-std::numeric_limits<float>::max());
        for (const glm::vec3& p : positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const float rounding = 1e-4f * (1.0f + static_cast<float>(i));
        double ratio = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_LE(bounds.low[axis], low[axis] + rounding);
            ASSERT_GE(bounds.high[axis], high[axis] - rounding);
            ratio *= double((bounds.high[axis] - bounds.low[axis]) / (high[axis] - low[axis]));
        }
        if (natural) worst = std::max(worst, ratio);
    }
    EXPECT_LE(worst, 1.35);
}
