// SPDX-License-Identifier: MIT
//
// Normals and tangents with every instruction set of this machine, and with the scalar reference,
// compared with differences between posed points of the surface.
#include "EachTarget.h"
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "Turns.h"

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
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
