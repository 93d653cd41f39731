// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elastic shapes as the result of binding: from a mesh and a skeleton to correctives.
#include "Shapes.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

SkinMesh arm() {
    return shapes::cylinder(14.0, 16);
}

/// Bent by 13 degrees at rest, so that its bending direction is known.
RestSkeleton bones() {
    RestSkeleton skeleton;
    skeleton.add("upper", -1, glm::dvec3(0, 0, 0));
    skeleton.add("lower", 0, glm::dvec3(0, 7, 0.8));
    skeleton.joints.back().tip = glm::dvec3(0, 14, 0);
    return skeleton;
}

BindOptions elasticOptions() {
    BindOptions options;
    options.shapes = BindOptions::Shapes::Elastic;
    return options;
}

bool hasNote(const BindReport& report, const std::string& text) {
    return std::any_of(report.notes.begin(), report.notes.end(), [&text](const std::string& note) {
        return note.find(text) != std::string::npos;
    });
}

/// Largest displacement of a vertex by a joint's shapes, with the hinge bent to x.
double mostMoved(const Correctives& shapes, double x) {
    const CorrectiveJoint& joint = shapes.joints[0];
    CorrectiveJoint::Functions phi;
    joint.evaluate({x, 0.0}, phi);
    std::vector<double> weights(joint.modes, 0.0);
    for (std::size_t k = 0; k < joint.modes; ++k)
        for (std::size_t f = 0; f < joint.functionCount(); ++f)
            weights[k] += joint.coefficients[k * joint.functionCount() + f] * phi[f];
    double most = 0.0;
    for (const Correctives::Entry& entry : shapes.entries) {
        glm::dvec3 move(0.0);
        for (std::size_t k = 0; k < joint.modes; ++k)
            for (int axis = 0; axis < 3; ++axis)
                move[axis] +=
                    weights[k] * shapes.shares[entry.firstShare + 3 * k + std::size_t(axis)];
        most = std::max(most, glm::length(move) / Correctives::kUnit);
    }
    return most;
}

} // namespace

TEST(ElasticBind, ShapesAHinge) {
    BindReport report;
    const Binding first = bind(arm(), bones(), elasticOptions(), &report);
    EXPECT_FALSE(hasNote(report, "not elastic"));
    ASSERT_EQ(first.correctives.joints.size(), 1u);
    EXPECT_EQ(first.correctives.joints[0].joint, 1u);
    EXPECT_EQ(first.correctives.joints[0].basis, CorrectiveJoint::Basis::Hinge);
    // It is solved slightly in the other direction too: unconstrained shapes would grow there.
    const CorrectiveJoint& hinge = first.correctives.joints[0];
    ASSERT_LT(hinge.low.x, -0.2);
    // Knots are close enough for folds that begin to touch.
    for (std::size_t k = 1; k < hinge.knots.size(); ++k)
        EXPECT_LT(std::asin(hinge.knots[k]) - std::asin(hinge.knots[k - 1]), 0.5 * 0.36);
    const double other = mostMoved(first.correctives, hinge.low.x);
    EXPECT_GT(other, 0.01);
    EXPECT_LT(other, 0.2 * mostMoved(first.correctives, hinge.high.x));
}

TEST(ElasticBind, TellsHowFarItIsAndGivesUpWhenTold) {
    BindOptions options = elasticOptions();
    double last = 0.0;
    std::size_t solved = 0;
    options.progress = [&](const ProgressStep& step) {
        EXPECT_GE(step.fraction, last);
        last = step.fraction;
        if (step.what == "lower" && ++solved == 3) throw std::runtime_error("enough");
    };
    EXPECT_THROW(bind(arm(), bones(), options), std::runtime_error);
    EXPECT_GT(last, 0.05);
    EXPECT_LT(last, 1.0);
}

TEST(ElasticBind, WhatCannotBeSolvedHasFastShapesAndALine) {
    RestSkeleton straight;
    straight.add("upper", -1, glm::dvec3(0, 0, 0));
    straight.add("lower", 0, glm::dvec3(0, 7, 0));
    straight.joints.back().tip = glm::dvec3(0, 14, 0);
    BindReport report;
    const Binding binding = bind(arm(), straight, elasticOptions(), &report);
    EXPECT_TRUE(hasNote(report, "joint \"lower\" has fast shapes, not elastic ones"));
    BindOptions fast;
    fast.shapes = BindOptions::Shapes::Fast;
    EXPECT_EQ(binding.correctives.shares, bind(arm(), straight, fast).correctives.shares);
}

TEST(ElasticBind, TakesPaintedWeightsAndSeams) {
    const SkinMesh mesh = shapes::exploded(arm());
    VertexWeights weights;
    for (const glm::dvec3& p : mesh.positions) {
        const double lower = std::clamp((p.y - 6.0) / 2.0, 0.0, 1.0);
        weights.push_back({{0, 1.0 - lower}, {1, lower}});
    }
    BindReport report;
    const Binding binding = bindWeights(mesh, bones(), weights, elasticOptions(), &report);
    EXPECT_FALSE(hasNote(report, "not elastic"));
    EXPECT_FALSE(binding.correctives.empty());
    EXPECT_TRUE(bindWeights(mesh, bones(), weights).correctives.empty());
}

/// A sleeve of the arm's own faces, slightly above it.
TEST(ElasticBind, ClothesMoveAsTheSkinBelowThem) {
    SkinMesh mesh = arm();
    const SkinMesh bare = mesh;
    const auto skin = static_cast<std::uint32_t>(bare.positions.size());
    std::vector<std::uint32_t> copyOf(skin, 0);
    const auto isSleeve = [&](std::uint32_t v) {
        return std::abs(bare.positions[v].y - 7.0) < 3.1;
    };
    for (std::uint32_t v = 0; v < skin; ++v) {
        if (!isSleeve(v)) continue;
        copyOf[v] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(bare.positions[v] * glm::dvec3(1.03, 1.0, 1.03));
    }
    std::size_t corner = 0;
    for (const std::uint32_t size : bare.faceSizes) {
        const std::uint32_t* face = &bare.faceVertices[corner];
        corner += size;
        if (!std::all_of(face, face + size, isSleeve)) continue;
        mesh.faceSizes.push_back(size);
        for (std::uint32_t k = 0; k < size; ++k) mesh.faceVertices.push_back(copyOf[face[k]]);
    }
    BindReport report;
    const Binding binding = bind(mesh, bones(), elasticOptions(), &report);
    EXPECT_FALSE(hasNote(report, "not elastic"));
    ASSERT_GT(report.layeredVertices, 50u);
    const Correctives& shapes = binding.correctives;
    ASSERT_EQ(shapes.joints.size(), 1u);
    const std::size_t modes = shapes.joints[0].modes;
    const auto moveOf = [&](std::uint32_t v, std::size_t mode) {
        glm::vec3 move(0.0f);
        for (std::uint32_t e = shapes.firstEntry[v]; e < shapes.firstEntry[v + 1]; ++e)
            for (int axis = 0; axis < 3; ++axis)
                move[axis] =
                    shapes.shares[shapes.entries[e].firstShare + 3 * mode + std::size_t(axis)];
        return move;
    };
    float largest = 0.0f, apart = 0.0f;
    for (std::uint32_t v = 0; v < skin; ++v) {
        if (copyOf[v] == 0 || std::abs(bare.positions[v].y - 7.0) > 2.0) continue;
        for (std::size_t k = 0; k < modes; ++k) {
            const glm::vec3 below = moveOf(v, k);
            largest = std::max(largest, glm::length(below));
            apart = std::max(apart, glm::length(moveOf(copyOf[v], k) - below));
        }
    }
    EXPECT_GT(largest, 1000.0f); // of 32767, the maximum of a stored share
    EXPECT_LT(apart, 0.02f * largest);
}

/// An arm whose forearm has a second bone in line with the first, for twists.
TEST(FindShapedJoints, LeavesOutTwistBones) {
    RestSkeleton skeleton;
    skeleton.add("Spine", -1, glm::dvec3(0, 0, 0));
    skeleton.add("LeftArm", 0, glm::dvec3(0, 1, 0));
    skeleton.add("LeftForeArm", 1, glm::dvec3(0, 5, 0.5));
    skeleton.add("LeftForeArmRoll", 2, glm::dvec3(0, 8.6, 0.25));
    skeleton.add("LeftHand", 3, glm::dvec3(0, 12.2, 0.0));
    skeleton.joints.back().tip = glm::dvec3(0, 14, -0.125);
    BindOptions options;
    options.shapes = BindOptions::Shapes::Fast;
    std::vector<std::uint32_t> shaped;
    for (const CorrectiveJoint& joint : bind(arm(), skeleton, options).correctives.joints)
        shaped.push_back(joint.joint);
    EXPECT_EQ(std::count(shaped.begin(), shaped.end(), 2u), 1) << "the elbow";
    EXPECT_EQ(std::count(shaped.begin(), shaped.end(), 3u), 0) << "the twist bone";
}
