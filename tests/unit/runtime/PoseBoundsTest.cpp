// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include "Tube.h"
#include "Turns.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

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

/// Legs that part from a trunk: vertices follow both in part, in front of a knee and a moved,
/// scaled foot.
osgSkin::Binding forkedBinding(const std::vector<glm::vec3>& positions, const char* rightName) {
    const glm::dvec3 down(0, -1, 0);
    osgSkin::Binding binding;
    binding.joints = {{"root", -1, {0, 0, 0}, down, down},
                      {"left", 0, {1, -1, 0}, down, down},
                      {"knee", 1, {1, -3, 0}, down, down},
                      {rightName, 0, {-1, -1, 0}, down, down}};
    binding.firstInfluence.push_back(0);
    const auto ratio = [](float x) { return std::min(1.0f, std::max(0.0f, x)); };
    for (const glm::vec3& p : positions) {
        binding.influences.push_back({0, 1.0f, 1.0f});
        const float left = ratio(0.5f + 0.4f * p.x - 0.3f * p.y);
        const float right = ratio(0.4f - 0.5f * p.x - 0.2f * p.y);
        const float knee = ratio(-p.y - 2.5f), kneeTwist = ratio(-0.5f * p.y - 0.5f);
        if (left > 0.0f) binding.influences.push_back({1, left, ratio(1.3f * left)});
        if (knee > 0.0f || kneeTwist > 0.0f) binding.influences.push_back({2, knee, kneeTwist});
        if (right > 0.0f) binding.influences.push_back({3, right, right});
        binding.regions.push_back(0);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    return binding;
}

void checkTwoBranches(const char* rightName) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<float> x(-2.0f, 2.0f), y(-4.0f, 1.0f);
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> source;
    for (std::uint32_t v = 0; v < 1500; ++v) {
        positions.emplace_back(x(random), y(random), 0.3f * x(random));
        normals.emplace_back(test::randomUnit(random));
        source.push_back(v);
    }
    const osgSkin::Binding binding = forkedBinding(positions, rightName);
    const auto model = osgSkin::SkinModel::create(binding, positions, normals, source);
    osgSkin::Pose pose(model->joints());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.positionCount = positions.size();
    std::uniform_real_distribution<double> growth(0.5, 2.0), way(-1.0, 1.0), share(0.0, 1.0);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(i);
        std::vector<osgSkin::JointMap> own;
        for (const osgSkin::BoundJoint& joint : model->joints()) {
            osgSkin::JointMap map;
            map.rotation = glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), test::randomRotation(random),
                                      share(random));
            if (i % 4 == 1) map.scale = growth(random);
            map.offset = joint.centre - map.scale * (map.rotation * joint.centre);
            if (i % 4 >= 2) map.offset += glm::dvec3(way(random), way(random), way(random));
            own.push_back(map);
        }
        const auto twist =
            i % 2 == 0 ? osgSkin::Pose::Twist::Shortest : osgSkin::Pose::Twist::Continued;
        ASSERT_TRUE(pose.set(own.data(), own.size(), twist));
        ASSERT_TRUE(job.run());
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        for (const glm::vec3& p : positions)
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], bounds.low[axis] - 1e-4f);
                ASSERT_LE(p[axis], bounds.high[axis] + 1e-4f);
            }
    }
}

} // namespace

TEST(PoseBounds, ContainVerticesOfTwoBranches) {
    checkTwoBranches("right");
}

/// The branch that is the last of the file is the first of the product.
TEST(PoseBounds, ContainVerticesOfBranchesInAnotherOrder) {
    checkTwoBranches("first");
}

TEST(PoseBounds, ContainEveryVertexAndStayClose) {
    EXPECT_LE(checkBounds(1.0), 1.35);
}

TEST(PoseBounds, ContainEveryVertexByEveryInstructionSet) {
    for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
        SCOPED_TRACE(hwy::TargetName(rest & -rest));
        hwy::SetSupportedTargetsForTest(rest & -rest);
        EXPECT_LE(checkBounds(1.0), 1.35);
        checkBounds(1.2);
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(PoseBounds, ContainEveryVertexOfScaledJoints) {
    EXPECT_LE(checkBounds(1.2), 2.2);
    checkBounds(4.0);
}

/// Thousands of joints below a long chain, one a vertex: pieces are cut by what their vertices
/// follow differently, which must not be looked for in all that they follow, again and again.
TEST(PoseBounds, AreMadeOfManyJointsInSeconds) {
    constexpr std::uint32_t kChain = 900, kLeaves = 4'000;
    osgSkin::Binding binding;
    for (std::uint32_t j = 0; j < kChain + kLeaves; ++j) {
        osgSkin::BoundJoint joint;
        joint.name = std::to_string(j);
        joint.parent = static_cast<int>(std::min(j, kChain)) - 1;
        joint.boneAxis = joint.twistAxis = {0.0, 1.0, 0.0};
        binding.joints.push_back(joint);
    }
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> source;
    binding.firstInfluence = {0};
    for (std::uint32_t v = 0; v < kLeaves; ++v) {
        for (std::uint32_t j = 0; j < kChain; ++j) binding.influences.push_back({j, 1.0f, 1.0f});
        binding.influences.push_back({kChain + v, 1.0f, 1.0f});
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        source.push_back(v);
        positions.emplace_back(v % 7, static_cast<float>(v) / 500.0f, v % 5);
    }
    binding.regions.assign(positions.size(), 0);
    const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
    const std::clock_t begin = std::clock();
    const auto model = osgSkin::SkinModel::create(binding, positions, normals, source);
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_EQ(model->vertexCount(), kLeaves);
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG) // which counting lines is, too
    constexpr double kMaxSeconds = 40.0;
#else
    constexpr double kMaxSeconds = 8.0;
#endif
    EXPECT_LT(seconds, kMaxSeconds) << "of this program's own";
}
