// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include "Tube.h"
#include "Turns.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

/// \param grown by how much the joints scale at most, up or down
/// \return the largest volume against the tight box's, in an animal's poses
double checkBounds(double grown) {
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
        auto skinning = test::skinningFrom(model->joints(), turns, glm::dvec3(i, 2 * i, -i));
        std::uniform_real_distribution<double> growth(1.0 / grown, grown);
        for (std::size_t j = 0; grown != 1.0 && j < skinning.size(); ++j) {
            const glm::dvec3 c = model->joints()[j].centre;
            const glm::dmat4 own = glm::translate(glm::dmat4(1.0), c) *
                                   glm::scale(glm::dmat4(1.0), glm::dvec3(growth(random))) *
                                   glm::translate(glm::dmat4(1.0), -c);
            for (std::size_t below = j; below < skinning.size(); ++below)
                skinning[below] = skinning[j] * own * glm::inverse(skinning[j]) * skinning[below];
        }
        EXPECT_TRUE(pose.set(skinning.data(), skinning.size()));
        EXPECT_TRUE(job.run());
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
            EXPECT_LE(bounds.low[axis], low[axis] + rounding);
            EXPECT_GE(bounds.high[axis], high[axis] - rounding);
            ratio *= double((bounds.high[axis] - bounds.low[axis]) / (high[axis] - low[axis]));
        }
        if (natural) worst = std::max(worst, ratio);
    }
    return worst;
}

} // namespace

TEST(PoseBounds, ContainEveryVertexAndStayClose) {
    EXPECT_LE(checkBounds(1.0), 1.35);
}

TEST(PoseBounds, ContainEveryVertexOfScaledJoints) {
    EXPECT_LE(checkBounds(1.2), 2.2);
    checkBounds(4.0);
}
