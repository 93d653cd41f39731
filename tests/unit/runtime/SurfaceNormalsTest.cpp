// SPDX-License-Identifier: MIT
//
// Normals and tangents with every instruction set of this machine, and with the scalar reference,
// compared with differences between posed points of the surface.
#include "EachTarget.h"
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/PoseBounds>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

namespace {

/// The error of invisible approximations and of rounding gradients; radians.
constexpr double kTolerance = 5e-3;

glm::dvec4 restTangentAt(const test::SlopedTube& tube, std::size_t v) {
    const glm::dvec3 around = glm::cross(glm::dvec3(tube.normals[v]), glm::dvec3(0, 1, 0));
    return {1.5 * glm::normalize(around + glm::dvec3(0, 0.7, 0)), v % 3 == 0 ? -1.0 : 1.0};
}

/// Normals, and tangents where there are rest tangents.
osgSkin::DeformOptions normalsAnd(const osgSkin::SkinTangents* restTangents) {
    osgSkin::DeformOptions options;
    options.normals = true;
    options.restTangents = restTangents;
    return options;
}

osg::ref_ptr<const osgSkin::SkinTangents> tangentsOf(const test::SlopedTube& tube,
                                                     const osgSkin::SkinModel& model) {
    std::vector<glm::vec4> tangents;
    for (std::size_t v = 0; v < tube.positions.size(); ++v)
        tangents.emplace_back(restTangentAt(tube, v));
    return osgSkin::SkinTangents::create(osg::ref_ptr<const osgSkin::SkinModel>(&model),
                                         std::move(tangents));
}

/// Rotations of up to a right angle; with `moved`, also translated and scaled joints.
osgSkin::Pose poseOf(const osgSkin::Binding& binding, std::mt19937_64& random, bool moved) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    std::vector<glm::dmat4> skinning;
    const glm::dmat4 unit(1.0);
    for (const osgSkin::BoundJoint& joint : binding.joints) {
        const glm::dvec3 move(number(random), number(random), number(random));
        const double scale = 1.0 + 0.2 * number(random);
        glm::dmat4 turn =
            glm::translate(unit, joint.centre + (moved ? 0.2 : 0.0) * move) *
            glm::mat4_cast(glm::angleAxis(1.5 * number(random), test::randomUnit(random)));
        if (moved) turn = glm::scale(turn, glm::dvec3(scale));
        turn = glm::translate(turn, -joint.centre);
        skinning.push_back(joint.parent < 0 ? turn : skinning[std::size_t(joint.parent)] * turn);
    }
    osgSkin::Pose pose(binding.joints);
    EXPECT_TRUE(pose.set(skinning.data(), skinning.size()));
    return pose;
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

class SurfaceNormals : public test::EachTarget {
protected:
    osgSkin::DeformedVertices posed(const osgSkin::SkinModel& model, const osgSkin::Pose& pose,
                                    const osgSkin::SkinTangents* restTangents = nullptr) const {
        return deform(model, pose, normalsAnd(restTangents));
    }
};

osgSkin::DeformedVertices byReference(const osgSkin::SkinModel& model, const osgSkin::Pose& pose,
                                      const osgSkin::SkinTangents* restTangents) {
    osgSkin::DeformOptions options = normalsAnd(restTangents);
    options.reference = true;
    return osgSkin::deform(model, pose, options);
}

} // namespace

TEST_P(SurfaceNormals, MatchThePosedSurface) {
    std::mt19937_64 random(11);
    for (const bool moved : {false, true})
        for (int sides = 1; sides <= 40; sides += 3) {
            SCOPED_TRACE(sides);
            test::SlopedTube tube(21, sides);
            if (sides % 2 == 0) tube.bringIntoOrder();
            const auto model = tube.model();
            ASSERT_TRUE(model->hasSurfaceNormals());
            const auto rest = tangentsOf(tube, *model);
            const osgSkin::Pose pose = poseOf(tube.binding, random, moved);
            const auto is = posed(*model, pose, rest.get());
            const auto alone = posed(*model, pose); // normals without tangents
            for (std::size_t v = 0; v < is.normals.size(); ++v) {
                const glm::dvec3 x(tube.positions[v]), n(tube.normals[v]);
                const glm::dvec3 around = glm::cross(glm::dvec3(0, 1, 0), n);
                const glm::dvec3 normal = glm::cross(tube.posedWay(pose, x, around),
                                                     tube.posedWay(pose, x, glm::cross(n, around)));
                ASSERT_LE(angleBetween(normal, is.normals[v]), kTolerance) << v;
                ASSERT_NEAR(glm::length(is.normals[v]), 1.0, 1e-5);
                ASSERT_LE(glm::distance(is.normals[v], alone.normals[v]), 1e-5f);

                const glm::dvec4 restTangent = restTangentAt(tube, v);
                const glm::dvec3 tangent(is.tangents[v]);
                ASSERT_LE(angleBetween(tube.posedWay(pose, x, glm::dvec3(restTangent)), tangent),
                          2.0 * kTolerance)
                    << v;
                ASSERT_NEAR(glm::length(tangent), 1.5, 1e-4);
                ASSERT_NEAR(glm::dot(tangent, glm::dvec3(is.normals[v])), 0.0, 1e-4);
                ASSERT_EQ(is.tangents[v].w, float(restTangent.w));
            }
        }
}

/// At the limits of bone scale the squared length of a direction is beyond single precision.
TEST_P(SurfaceNormals, HaveUnitLengthAtAnyScale) {
    const test::SlopedTube tube;
    const auto model = tube.model();
    const auto rest = tangentsOf(tube, *model);
    for (const double scale : {0.99e9, 1e6, 1e-6, 1.01e-9})
        for (const std::size_t scaled : {0u, 1u, 2u}) {
            SCOPED_TRACE(std::to_string(scale) + " of joint " + std::to_string(scaled));
            const std::vector<osgSkin::JointMap> maps = tube.scaledMaps(scaled, scale);
            osgSkin::Pose pose(tube.binding.joints);
            ASSERT_TRUE(pose.set(maps.data(), maps.size()));
            const auto is = posed(*model, pose, rest.get());
            const auto expected = byReference(*model, pose, rest.get());
            for (std::size_t v = 0; v < is.normals.size(); ++v) {
                ASSERT_LE(angleBetween(expected.normals[v], is.normals[v]), kTolerance) << v;
                ASSERT_NEAR(glm::length(is.normals[v]), 1.0, 1e-5) << v;
                ASSERT_NEAR(glm::length(glm::dvec3(is.tangents[v])), 1.5, 1e-4) << v;
            }
        }
}

/// Joints without gradients, before and after one that has some.
TEST_P(SurfaceNormals, MatchTheReferenceIfSomeJointsHaveNoGradients) {
    std::mt19937_64 random(13);
    for (const bool moved : {false, true})
        for (const std::uint32_t even : {1u, 2u}) {
            SCOPED_TRACE(std::to_string(even) + (moved ? " moved" : ""));
            test::SlopedTube tube(41, 18);
            for (std::size_t i = 0; i < tube.binding.influences.size(); ++i)
                if (tube.binding.influences[i].joint == even) tube.binding.gradients[i] = {};
            const auto model = tube.model();
            ASSERT_TRUE(model->hasSurfaceNormals());
            const auto rest = tangentsOf(tube, *model);
            const osgSkin::Pose pose = poseOf(tube.binding, random, moved);
            const auto is = posed(*model, pose, rest.get());
            const auto expected = byReference(*model, pose, rest.get());
            for (std::size_t v = 0; v < is.normals.size(); ++v) {
                ASSERT_LE(glm::distance(is.positions[v], expected.positions[v]), 1e-4f) << v;
                ASSERT_LE(angleBetween(is.normals[v], expected.normals[v]), kTolerance) << v;
                ASSERT_LE(
                    angleBetween(glm::dvec3(is.tangents[v]), glm::dvec3(expected.tangents[v])),
                    2.0 * kTolerance)
                    << v;
            }
        }
}

TEST_P(SurfaceNormals, DifferFromRotatedNormals) {
    std::mt19937_64 random(12);
    const test::SlopedTube tube(25, 18);
    test::SlopedTube plain = tube;
    plain.binding.gradients.clear();
    const auto model = tube.model(), turned = plain.model();
    EXPECT_FALSE(turned->hasSurfaceNormals());
    const osgSkin::Pose pose = poseOf(tube.binding, random, false);
    const auto with = posed(*model, pose), without = posed(*turned, pose);
    EXPECT_EQ(with.positions, without.positions);
    double most = 0.0;
    for (std::size_t v = 0; v < with.normals.size(); ++v)
        most = std::max(most, angleBetween(with.normals[v], without.normals[v]));
    EXPECT_GE(glm::degrees(most), 10.0);
}

TEST_P(SurfaceNormals, KeepPrecisionBesideASteepGradient) {
    std::mt19937_64 random(14);
    const test::SlopedTube tube(25, 18);
    test::SlopedTube steep = tube;
    const std::uint32_t last = static_cast<std::uint32_t>(tube.positions.size()) / 2;
    for (std::uint32_t i = steep.binding.firstInfluence[last];
         i < steep.binding.firstInfluence[last + 1]; ++i)
        steep.binding.gradients[i].bend = glm::vec3(1e6f, 1e6f, -1e6f);
    const auto model = tube.model(), other = steep.model();
    const osgSkin::Pose pose = poseOf(tube.binding, random, false);
    const auto without = posed(*model, pose), with = posed(*other, pose);
    for (std::size_t v = 0; v < with.normals.size(); ++v) {
        if (v == last) continue;
        ASSERT_LE(angleBetween(without.normals[v], with.normals[v]), kTolerance) << v;
    }
}

TEST_P(SurfaceNormals, MatchRestNormalsInTheRestPose) {
    const test::SlopedTube tube(25, 18);
    const auto model = tube.model();
    const auto rest = tangentsOf(tube, *model);
    const osgSkin::Pose pose(tube.binding.joints);
    const auto is = posed(*model, pose, rest.get());
    for (std::size_t v = 0; v < is.normals.size(); ++v) {
        EXPECT_LE(glm::distance(is.normals[v], tube.normals[v]), 2e-6f);
        EXPECT_LE(glm::distance(is.tangents[v], rest->tangents()[v]), 2e-6f);
    }
}

TEST_P(SurfaceNormals, IncludeCorrectives) {
    std::mt19937_64 random(13);
    for (const bool sloped : {false, true})
        for (const bool withTangents : {false, true}) {
            test::SlopedTube tube(25, 37);
            tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 3, true);
            if (!sloped) tube.binding.gradients.clear();
            if (withTangents) tube.bringIntoOrder();
            const auto model = tube.model();
            const auto rest = tangentsOf(tube, *model);
            const osgSkin::Pose pose = poseOf(tube.binding, random, false);
            const auto is = posed(*model, pose, withTangents ? rest.get() : nullptr);
            const auto expected = byReference(*model, pose, rest.get());
            for (std::size_t v = 0; v < is.normals.size(); ++v) {
                ASSERT_LE(glm::distance(is.normals[v], expected.normals[v]), 1e-4f) << v;
                if (!withTangents) continue;
                ASSERT_LE(glm::distance(is.tangents[v], expected.tangents[v]), 1e-4f) << v;
                ASSERT_NEAR(glm::dot(is.normals[v], glm::vec3(is.tangents[v])), 0.0f, 1e-4f);
            }
        }
}

TEST_P(SurfaceNormals, RotateCorrectedNormalsWithoutGradients) {
    std::mt19937_64 random(14);
    test::SlopedTube tube(25, 12);
    tube.binding.gradients.clear();
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.2, 4, true);
    const auto model = tube.model();
    const osgSkin::Pose pose = poseOf(tube.binding, random, false);
    const std::vector<glm::vec3> normals = posed(*model, pose).normals;
    for (std::uint32_t v = 0; v < normals.size(); ++v) {
        glm::dvec3 n =
            glm::dvec3(tube.normals[v]) + test::normalCorrectionOf(tube.binding, pose, v);
        n = glm::normalize(n);
        for (std::uint32_t i = tube.binding.firstInfluence[v + 1];
             i-- > tube.binding.firstInfluence[v];) {
            const osgSkin::Influence& influence = tube.binding.influences[i];
            n = osgSkin::partialRotation(pose.transform(influence.joint).split,
                                         tube.binding.joints[influence.joint].twistAxis,
                                         double(influence.bend), double(influence.twist)) *
                n;
        }
        ASSERT_LE(glm::distance(glm::dvec3(normals[v]), n), 1e-5) << v;
    }
}

TEST_P(SurfaceNormals, PartsMatchTheWhole) {
    if (isReference()) return; // it is not divided into parts
    std::mt19937_64 random(15);
    for (const bool inOrder : {false, true}) {
        test::SlopedTube tube(25, 777);
        tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 5, true);
        if (inOrder) tube.bringIntoOrder();
        const auto model = tube.model();
        const auto rest = tangentsOf(tube, *model);
        const osgSkin::Pose pose = poseOf(tube.binding, random, false);
        const auto whole = posed(*model, pose, rest.get());
        const auto parts = test::deformInParts(*model, pose, normalsAnd(rest.get()));
        EXPECT_EQ(parts.normals, whole.normals);
        EXPECT_EQ(parts.tangents, whole.tangents);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, SurfaceNormals, testing::ValuesIn(test::allTargets()),
                         [](const auto& tested) { return tested.param.name; });

namespace {

/// \param grown largest scale of the joints, up or down
/// \return the largest volume relative to the tight box's, over natural poses
double checkBounds(double grown) {
    const test::Tube tube(61, 24);
    const auto model = tube.model();
    osgSkin::Pose pose(model->joints());
    std::mt19937_64 random(6);
    double worst = 0.0; // volume relative to the tight box's
    for (int i = 0; i < 300; ++i) {
        // Every other pose is natural (joint angles of at most 90 degrees), the others are
        // arbitrary.
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
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        glm::vec3 low(std::numeric_limits<float>::max());
        glm::vec3 high(-std::numeric_limits<float>::max());
        for (const glm::vec3& p : osgSkin::deform(*model, pose).positions) {
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

/// Legs that branch from a trunk: vertices follow both in part, above a knee and a moved, scaled
/// foot.
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
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        for (const glm::vec3& p : osgSkin::deform(*model, pose).positions)
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

/// The last branch of the file is the first one in the product.
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

/// Thousands of joints below a long chain, one per vertex: pieces are split by the joints in which
/// their vertices differ, and finding these must not search all joints again and again.
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
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG) // also slow at counting lines
    constexpr double kMaxSeconds = 40.0;
#else
    constexpr double kMaxSeconds = 8.0;
#endif
    EXPECT_LT(seconds, kMaxSeconds) << "of this program's own";
}
