// SPDX-License-Identifier: MIT
//
// Correctives with every instruction set of this machine, and with the scalar reference, compared
// with the formula in double precision.
#include "EachTarget.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/Error>
#include <osgSkin/Pose>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace {

/// A tube with correctives; its vertices may be sorted so that the deformation writes its results
/// in order.
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
    std::uniform_real_distribution<float> input(-0.5f, 1.5f); // also out of range
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

TEST_P(CorrectedKernel, MatchesDoublePrecision) {
    std::mt19937_64 random(5);
    for (const bool inBestOrder : {false, true})
        for (int sides = 1; sides <= 40; sides += 3) {
            SCOPED_TRACE(sides);
            const CorrectedTube skin(21, sides, inBestOrder);
            const auto model = skin.model();
            ASSERT_TRUE(model->hasCorrectives());
            for (std::uint32_t i = 0; inBestOrder && i < model->order().size(); ++i)
                ASSERT_EQ(model->order()[i], i);
            for (const bool withNormals : {false, true}) {
                const osgSkin::Pose pose = tubePose(skin.binding, random);
                osgSkin::DeformOptions options;
                options.normals = withNormals;
                const std::vector<glm::vec3> positions = deform(*model, pose, options).positions;
                for (std::uint32_t v = 0; v < positions.size(); ++v) {
                    const glm::dvec3 x =
                        expected(skin.binding, pose, skin.source[v], glm::dvec3(skin.positions[v]));
                    ASSERT_TRUE(glm::distance(glm::dvec3(positions[v]), x) <= 1e-5)
                        << v << ", off by " << glm::distance(glm::dvec3(positions[v]), x);
                }
            }
        }
}

TEST_P(CorrectedKernel, PartsMatchTheWhole) {
    if (isReference()) return; // it is not divided into parts
    std::mt19937_64 random(6);
    for (const bool inBestOrder : {false, true}) {
        const CorrectedTube skin(25, 777, inBestOrder);
        const auto model = skin.model();
        const osgSkin::Pose pose = tubePose(skin.binding, random);
        EXPECT_EQ(test::deformInParts(*model, pose).positions, deform(*model, pose).positions);
    }
}

TEST_P(CorrectedKernel, ChangesNothingAtRest) {
    const CorrectedTube skin(21, 7, true);
    test::Tube plain = skin;
    plain.binding.correctives = {};
    const osgSkin::Pose pose(skin.binding.joints);
    const std::vector<glm::vec3> positions = deform(*skin.model(), pose).positions;
    const std::vector<glm::vec3> without = deform(*plain.model(), pose).positions;
    for (std::size_t v = 0; v < positions.size(); ++v)
        EXPECT_LE(glm::distance(positions[v], without[v]), 2e-6f) << v;
}

INSTANTIATE_TEST_SUITE_P(Targets, CorrectedKernel, testing::ValuesIn(test::allTargets()),
                         [](const auto& tested) { return tested.param.name; });

using osgSkin::CorrectiveJoint;
using Basis = osgSkin::CorrectiveJoint::Basis;

namespace {

CorrectiveJoint functionsOf(Basis basis) {
    std::mt19937_64 random(3);
    return test::someFunctions(test::Tube().binding, 1, basis, 1.0, random);
}

} // namespace

TEST(CorrectiveJoint, CoordinatesMatchTheBendQuaternion) {
    const CorrectiveJoint joint = functionsOf(Basis::Ball);
    const glm::dvec3 w(0, 1, 0), e1 = joint.axis, e2 = glm::cross(w, e1);
    for (const double angle : {0.0, 0.4, 2.0, 3.1})
        for (const double azimuth : {0.0, 1.0, -2.5}) {
            const glm::dvec3 v = std::cos(azimuth) * e1 + std::sin(azimuth) * e2;
            const glm::dvec2 xy = joint.coordinates(v, angle, w);
            EXPECT_NEAR(xy.x, std::sin(angle / 2) * std::cos(azimuth), 1e-14);
            EXPECT_NEAR(xy.y, std::sin(angle / 2) * std::sin(azimuth), 1e-14);
        }
}

TEST(CorrectiveJoint, ClampIsSmoothAndEndsAtTheRange) {
    for (const Basis basis : {Basis::Hinge, Basis::Ball, Basis::Round, Basis::TurnedHinge}) {
        const CorrectiveJoint joint = functionsOf(basis);
        EXPECT_EQ(joint.clamped({0.3, -0.2}), glm::dvec2(0.3, -0.2));
        EXPECT_NEAR(joint.clamped({0.9, 0.0}).x, 0.9 * (0.9 + 0.1 * std::tanh(1.0)), 1e-14);
        EXPECT_NEAR(joint.clamped({0.0, -50.0}).y, -0.8, 1e-12);
        // No step and no kink anywhere.
        glm::dvec2 last = joint.clamped({-1.0, 0.1}), lastSlope(0.0);
        for (double x = -0.999; x < 1.0; x += 0.001) {
            const glm::dvec2 now = joint.clamped({x, 0.1});
            const glm::dvec2 slope = (now - last) / 0.001;
            EXPECT_LE(glm::length(slope), 1.02) << x;
            if (x > -0.9985) {
                EXPECT_LE(glm::length(slope - lastSlope), 0.02) << x;
            }
            last = now;
            lastSlope = slope;
        }
    }
}

TEST(CorrectiveJoint, FunctionsAreSmoothAndZeroAtRest) {
    for (const Basis basis : {Basis::Hinge, Basis::Ball, Basis::Round, Basis::TurnedHinge}) {
        const CorrectiveJoint joint = functionsOf(basis);
        CorrectiveJoint::Functions phi{}, before{}, behind{};
        joint.evaluate({0.0, 0.0}, phi);
        for (std::size_t i = 0; i < joint.functionCount(); ++i) EXPECT_EQ(phi[i], 0.0);
        const double h = 1e-5;
        for (double x = -0.45; x < 0.88; x += 0.01) {
            joint.evaluate({x, 0.2}, phi);
            joint.evaluate({x - h, 0.2}, before);
            joint.evaluate({x + h, 0.2}, behind);
            for (std::size_t i = 0; i < joint.functionCount(); ++i) // a kink would be of order 1
                EXPECT_NEAR((behind[i] - phi[i]) / h, (phi[i] - before[i]) / h, 2e-3)
                    << i << " at " << x;
        }
    }
}

TEST(CorrectiveJoint, HingeSplinesReproduceALinearFunction) {
    // Greville's points reproduce x; without the constant function, too.
    const CorrectiveJoint joint = functionsOf(Basis::Hinge);
    const std::vector<double>& t = joint.knots;
    std::vector<double> points = {t[0]};
    for (std::size_t i = 0; i + 1 < t.size(); ++i) points.push_back(0.5 * (t[i] + t[i + 1]));
    points.push_back(t.back());
    CorrectiveJoint::Functions phi;
    for (double x = -0.5; x <= 0.9; x += 0.1) {
        joint.evaluate({x, 0.0}, phi);
        double sum = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) sum += points[i] * phi[i];
        EXPECT_NEAR(sum, x, 1e-12);
    }
}

TEST(Correctives, RejectInvalidDataWithAReason) {
    using Spoil = std::function<void(osgSkin::Correctives&)>;
    const test::Tube tube;
    const std::pair<const char*, Spoil> cases[] = {
        {"is not there", [](auto& c) { c.joints[0].joint = 9; }},
        {"perpendicular",
         [](auto& c) {
             c.joints[0].axis = {0, 1, 0};
         }},
        {"perpendicular", [](auto& c) { c.joints[0].axis *= 2.0; }},
        {"range", [](auto& c) { c.joints[0].low.x = 0.0; }},
        {"range", [](auto& c) { c.joints[0].high.y = std::nan(""); }},
        {"knots", [](auto& c) { c.joints[0].knots = {0.5}; }},
        {"must ascend", [](auto& c) { std::swap(c.joints[1].knots[0], c.joints[1].knots[1]); }},
        {"modes", [](auto& c) { c.joints[0].modes = 0; }},
        {"input 5 is not there", [](auto& c) { c.joints.back().joint = 5; }},
        {"input 0 is not there", [](auto& c) { c.inputs.clear(); }},
        {"does not hold 0", [](auto& c) { c.joints.back().low.x = 0.5; }},
        {"does not hold 0", [](auto& c) { c.joints.back().high.x = std::nan(""); }},
        {"an input must not have knots",
         [](auto& c) {
             c.joints.back().knots = {0.0, 1.0};
         }},
        {"two inputs", [](auto& c) { c.inputs.push_back(c.inputs.front()); }},
        {"each mode and function", [](auto& c) { c.joints[0].coefficients.pop_back(); }},
        {"not finite", [](auto& c) { c.joints[0].coefficients[0] = std::nan(""); }},
        {"beyond", [](auto& c) { c.joints[0].coefficients[0] = -1e30; }},
        {"scale of normals", [](auto& c) { c.joints[0].normalScales = {1.0}; }},
        {"offsets", [](auto& c) { c.firstEntry.pop_back(); }},
        {"no joint's modes", [](auto& c) { c.entries[0].joint = 7; }},
        {"share index out of range", [](auto& c) { c.entries[0].firstShare = 1u << 30; }},
        {"less than", [](auto& c) { c.shares[0] = -32768; }},
        {"as many shares",
         [](auto& c) {
             c.normalShares = {1};
             for (auto& joint : c.joints) joint.normalScales.assign(joint.modes, 1.0);
         }},
        {"out of order", [](auto& c) {
             for (std::size_t v = 0; v + 1 < c.firstEntry.size(); ++v)
                 if (c.firstEntry[v + 1] - c.firstEntry[v] == 2)
                     std::swap(c.entries[c.firstEntry[v]], c.entries[c.firstEntry[v] + 1]);
         }}};
    for (const auto& [reason, spoil] : cases) {
        osgSkin::Binding binding = tube.binding;
        binding.correctives = test::someCorrectives(binding, 0.1, 4);
        EXPECT_NO_THROW(binding.validate());
        spoil(binding.correctives);
        try {
            binding.validate();
            ADD_FAILURE() << "accepted: " << reason;
        } catch (const osgSkin::Error& error) {
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    }
}
