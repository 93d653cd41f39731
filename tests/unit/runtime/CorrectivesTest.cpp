// SPDX-License-Identifier: MIT
//
// Correctives on every instruction set that this machine has, and in the scalar reference, against
// the formula worked out in double precision.
#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include "EachTarget.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "Turns.h"

#include <gtest/gtest.h>

#include <string>

namespace {

/// A tube with correctives, its vertices where the deformation writes them straight or not.
struct CorrectedTube : test::Tube {
    CorrectedTube(int rings, int sides, bool inBestOrder) : test::Tube(rings, sides) {
        const std::size_t modes = sides % 2 == 0 ? 14 : 1; // several vectors of them, or less
        binding.correctives =
            test::someCorrectives(binding, 0.3, std::uint64_t(rings), false, modes);
        if (!inBestOrder) return;
        const std::vector<glm::vec3> oldPositions = positions, oldNormals = normals;
        source = osgSkin::SkinModel::bestOrder(binding, source);
        for (std::size_t i = 0; i < source.size(); ++i) {
            positions[i] = oldPositions[source[i]];
            normals[i] = oldNormals[source[i]];
        }
    }
};

osgSkin::Pose tubePose(const osgSkin::Binding& binding, std::mt19937_64& random) {
    std::vector<glm::dquat> turns;
    for (std::size_t j = 0; j < binding.joints.size(); ++j)
        turns.push_back(test::randomRotation(random));
    const auto skinning = test::skinningFrom(binding.joints, turns);
    osgSkin::Pose pose(binding.joints, binding.correctives.inputs.size());
    EXPECT_TRUE(pose.set(skinning.data(), skinning.size()));
    std::uniform_real_distribution<float> input(-0.5f, 1.5f); // beyond its range, too
    for (std::size_t i = 0; i < binding.correctives.inputs.size(); ++i)
        EXPECT_TRUE(pose.setInput(i, input(random)));
    return pose;
}

glm::dvec3 expected(const osgSkin::Binding& binding, const osgSkin::Pose& pose,
                    std::uint32_t vertex, glm::dvec3 x) {
    x += test::correctionOf(binding, pose, vertex);
    for (std::uint32_t i = binding.firstInfluence[vertex + 1];
         i-- > binding.firstInfluence[vertex];) {
        const osgSkin::Influence& influence = binding.influences[i];
        const osgSkin::BoundJoint& joint = binding.joints[influence.joint];
        const glm::dquat q =
            osgSkin::partialRotation(pose.transform(influence.joint).split, joint.twistAxis,
                                     double(influence.bend), double(influence.twist));
        x = joint.centre + q * (x - joint.centre);
    }
    return x;
}

class CorrectedKernel : public test::EachTarget {};

} // namespace

TEST_P(CorrectedKernel, AgreesWithDoublePrecision) {
    std::mt19937_64 random(5);
    for (const bool inBestOrder : {false, true})
        for (int sides = 1; sides <= 40; sides += 3) {
            SCOPED_TRACE(sides);
            const CorrectedTube skin(21, sides, inBestOrder);
            const auto model = skin.model();
            ASSERT_TRUE(model->hasCorrectives());
            for (std::uint32_t i = 0; inBestOrder && i < model->order().size(); ++i)
                ASSERT_EQ(model->order()[i], i);
            std::vector<glm::vec3> positions(model->vertexCount()), normals = positions;
            for (const bool withNormals : {false, true}) {
                const osgSkin::Pose pose = tubePose(skin.binding, random);
                osgSkin::DeformJob job;
                job.model = model.get();
                job.pose = &pose;
                job.positions = positions.data();
                job.normals = withNormals ? normals.data() : nullptr;
                job.positionCount = job.normalCount = positions.size();
                ASSERT_TRUE(run(job));
                for (std::uint32_t v = 0; v < positions.size(); ++v) {
                    const glm::dvec3 x =
                        expected(skin.binding, pose, skin.source[v], glm::dvec3(skin.positions[v]));
                    ASSERT_TRUE(glm::distance(glm::dvec3(positions[v]), x) <= 1e-5)
                        << v << ", off by " << glm::distance(glm::dvec3(positions[v]), x);
                }
            }
        }
}

TEST_P(CorrectedKernel, PartsInAnyOrderMakeTheWhole) {
    if (!GetParam().target) return; // the reference has no parts
    std::mt19937_64 random(6);
    for (const bool inBestOrder : {false, true}) {
        const CorrectedTube skin(25, 777, inBestOrder);
        const auto model = skin.model();
        const osgSkin::Pose pose = tubePose(skin.binding, random);
        std::vector<glm::vec3> whole(model->vertexCount()), parts = whole;
        osgSkin::DeformJob job;
        job.model = model.get();
        job.pose = &pose;
        job.positions = whole.data();
        job.positionCount = whole.size();
        ASSERT_TRUE(job.run());
        job.positions = parts.data();
        ASSERT_GE(job.partCount(), 3u);
        for (std::size_t part = job.partCount(); part-- > 0;) job.runPart(part);
        EXPECT_EQ(parts, whole);
    }
}

TEST_P(CorrectedKernel, RestPoseIsTheRestSkin) {
    const CorrectedTube skin(21, 7, true);
    const auto model = skin.model();
    osgSkin::Pose pose(skin.binding.joints);
    std::vector<glm::vec3> positions(model->vertexCount());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.positionCount = positions.size();
    ASSERT_TRUE(run(job));
    const auto plain = [&] {
        test::Tube tube = skin;
        tube.binding.correctives = {};
        return tube.model();
    }();
    std::vector<glm::vec3> without(positions.size());
    job.model = plain.get();
    job.positions = without.data();
    ASSERT_TRUE(run(job));
    for (std::size_t v = 0; v < positions.size(); ++v)
        EXPECT_LE(glm::distance(positions[v], without[v]), 2e-6f) << v;
}

INSTANTIATE_TEST_SUITE_P(Targets, CorrectedKernel, testing::ValuesIn(test::ways()),
                         [](const auto& tested) { return tested.param.name; });

TEST(CorrectedBounds, ContainEveryVertex) {
    std::mt19937_64 random(7);
    const CorrectedTube skin(41, 18, true);
    const auto model = skin.model();
    std::vector<glm::vec3> positions(model->vertexCount());
    bool anyNearby = false;
    for (int i = 0; i < 300; ++i) {
        const osgSkin::Pose pose = tubePose(skin.binding, random);
        osgSkin::DeformJob job;
        job.model = model.get();
        job.pose = &pose;
        job.positions = positions.data();
        job.positionCount = positions.size();
        ASSERT_TRUE(job.run());
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        for (const glm::vec3& p : positions)
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], bounds.low[axis] - 1e-4f);
                ASSERT_LE(p[axis], bounds.high[axis] + 1e-4f);
                anyNearby = anyNearby || p[axis] < bounds.low[axis] + 0.5f;
            }
    }
    EXPECT_TRUE(anyNearby); // they are no larger than they need to be
}
