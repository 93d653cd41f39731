// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elastic shapes as the result of binding: from a mesh and a skeleton to correctives.
//
// Two tubes side by side, like two legs.
//
// Skins and joints that are not a single intact closed tube.
//
// A real body's elbow, bent to 129 and 139 degrees of total flexion.
#include "ElasticTube.h"
#include "ScratchFolder.h"
#include "Shapes.h"
#include "SharedBody.h"
#include "TextFile.h"
#include "elastic/SolveElastic.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>

#include <correctives/ShapesCache.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

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

BindOptions elasticOptions(const std::string& cache = {}) {
    BindOptions options;
    options.shapes = BindOptions::Shapes::Elastic;
    options.cacheFolder = cache;
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

TEST(ElasticBind, ShapesAHingeAndKeepsWhatItMade) {
    const ScratchFolder scratch;
    const BindOptions options = elasticOptions((scratch.path() / "cache").string());
    BindReport report;
    const Binding first = bind(arm(), bones(), options, &report);
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
    const auto files = scratch.files();
    ASSERT_EQ(files.size(), 1u);

    std::vector<std::string> told;
    BindOptions again = options;
    again.progress = [&told](const ProgressStep& step) { told.push_back(step.what); };
    const Binding second = bind(arm(), bones(), again, &report);
    EXPECT_EQ(std::count(told.begin(), told.end(), "lower"), 0); // nothing was solved
    EXPECT_EQ(second.correctives.shares, first.correctives.shares);
    EXPECT_EQ(second.correctives.joints[0].coefficients, first.correctives.joints[0].coefficients);

    std::ofstream(files[0], std::ios::trunc) << "broken";
    const Binding third = bind(arm(), bones(), options, &report);
    EXPECT_TRUE(hasNote(report, "computed again"));
    EXPECT_EQ(third.correctives.shares, first.correctives.shares);
    bind(arm(), bones(), again, &report);
    EXPECT_FALSE(hasNote(report, "computed again"));
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

namespace {

/// Solved once for all tests, which only read it.
const ElasticShapes& bent() {
    static const ElasticTube tube;
    static const ElasticShapes shapes =
        solveElasticJoint(tube.skin(), tube.joint({30, 60, 90, 120}));
    return shapes;
}

} // namespace

TEST(ElasticCylinder, IsSolvedWithoutCrossingsOrInvertedCells) {
    ASSERT_EQ(bent().reason, "");
    ASSERT_EQ(bent().samples.size(), 4u);
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_EQ(sample.crossings, 0u);
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_EQ(sample.positions.size(), bent().vertices.size());
    }
    EXPECT_GT(bent().samples.back().plainCrossings, 20u); // else there was nothing to solve
}

TEST(ElasticCylinder, KeepsItsVolume) {
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_GT(sample.volumeRatio, 0.97);
        EXPECT_LT(sample.volumeRatio, 1.01);
    }
}

TEST(ElasticCylinder, OuterSideNeitherCavesInNorSwells) {
    const int angles[] = {30, 60, 90, 120};
    for (std::size_t i = 0; i < 4; ++i) {
        // Towards the outer side: the child's bone rotates from +y to +z.
        const double half = glm::radians(0.5 * angles[i]);
        const glm::dvec3 bone(0, std::cos(2.0 * half), std::sin(2.0 * half));
        const glm::dvec3 outwards(0, std::sin(half), -std::cos(half));
        double least = 1e9, most = 0.0;
        for (const glm::dvec3& p : bent().samples[i].positions) {
            const double height = glm::dot(p, glm::cross(outwards, glm::dvec3(1, 0, 0)));
            if (glm::dot(p, outwards) < 0.0 || std::abs(p.x) > 0.3 || std::abs(height) > 1.0)
                continue;
            const double below = glm::length(p - glm::dvec3(0, std::min(p.y, 0.0), 0));
            const double above = glm::length(p - std::max(glm::dot(p, bone), 0.0) * bone);
            least = std::min({least, below, above});
            most = std::max(most, std::min(below, above));
        }
        EXPECT_GT(least, 0.94) << angles[i];
        EXPECT_LT(most, 1.04) << angles[i];
    }
}

TEST(ElasticCylinder, ComesToTheSameFoldByAnyWay) {
    const ElasticTube tube;
    const ElasticShapes other = solveElasticJoint(tube.skin(), tube.joint({20, 50, 75, 98, 120}));
    const ElasticSample &a = bent().samples.back(), &b = other.samples.back();
    ASSERT_EQ(a.positions.size(), b.positions.size());
    EXPECT_TRUE(a.converged);
    EXPECT_TRUE(b.converged);
    for (std::size_t v = 0; v < a.positions.size(); ++v)
        EXPECT_LT(glm::length(a.positions[v] - b.positions[v]), 0.05);
}

/// For a bend that is too far, samples on the way to it are solved, so that functions can be
/// fitted.
TEST(ElasticCylinder, GoesPartOfTheWayToABendThatIsTooFar) {
    const ElasticTube tube;
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), tube.joint({90, 178}));
    ASSERT_GT(shapes.samples.size(), 2u);
    EXPECT_EQ(shapes.samples[0].reason, "");
    EXPECT_NE(shapes.samples[1].reason, "");
    double last = glm::radians(90.0);
    for (std::size_t i = 2; i < shapes.samples.size(); ++i) {
        EXPECT_EQ(shapes.samples[i].reason, "");
        const double angle = glm::angle(shapes.samples[i].rotation);
        EXPECT_GT(angle, last + 0.1);
        EXPECT_LT(angle, glm::radians(170.0));
        last = angle;
    }
}

TEST(ElasticCylinder, RimFollowsTheBones) {
    const ElasticShapes& shapes = bent();
    const double rim = shapes.reach - 1.0 / 3.0; // a cell
    std::size_t above = 0, below = 0;
    for (const ElasticSample& sample : shapes.samples)
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
            const glm::dvec3& rest = shapes.rest[v];
            if (glm::length(rest) < rim + 0.1) continue;
            const glm::dvec3 moved = rest.y > 0.0 ? sample.rotation * rest : rest;
            // Ratios within the flesh approach 0 and 1, but do not reach them.
            EXPECT_LT(glm::length(sample.positions[v] - moved), 1e-4);
            ++(rest.y > 0.0 ? above : below);
        }
    EXPECT_GT(above, 40u);
    EXPECT_GT(below, 40u);
}

TEST(ElasticCylinder, RestPoseIsTheRestSkin) {
    const ElasticTube tube;
    ElasticJoint joint = tube.joint({0});
    joint.samples.push_back(glm::angleAxis(1e-5, glm::dvec3(1, 0, 0))); // is minimised
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), joint);
    ASSERT_EQ(shapes.samples.size(), 2u);
    EXPECT_GT(shapes.samples[1].steps, 0);
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        EXPECT_LT(glm::length(shapes.samples[0].positions[v] - shapes.rest[v]), 1e-9);
        EXPECT_LT(glm::length(shapes.samples[1].positions[v] - shapes.rest[v]), 1e-4);
    }
    EXPECT_NEAR(shapes.samples[1].volumeRatio, 1.0, 1e-6);
}

TEST(ElasticCylinder, IsTheSameFromRunToRunInAnySizeAndPlace) {
    const ElasticTube tube, other(0.01, {5, -3, 2});
    const ElasticShapes a = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes b = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes c = solveElasticJoint(other.skin(), other.joint({25, -25}));
    ASSERT_EQ(a.vertices, c.vertices);
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_EQ(a.samples[s].positions, b.samples[s].positions);
        for (std::size_t v = 0; v < a.vertices.size(); ++v) {
            const glm::dvec3 back = (c.samples[s].positions[v] - glm::dvec3(5, -3, 2)) / 0.01;
            EXPECT_LT(glm::length(back - a.samples[s].positions[v]), 0.02);
        }
    }
}

namespace {

const glm::dvec3 kLeft(7.0, 1.0, 2.0), kRight(-5.0, 1.0, 2.0);

glm::dvec3 mirrored(const glm::dvec3& p) {
    return {2.0 - p.x, p.y, p.z};
}

class ElasticMirror : public ::testing::Test {
protected:
    ElasticMirror() {
        joints = {jointOf(left), jointOf(right)};
        const auto count = static_cast<std::uint32_t>(left.positions.size());
        joints[0].ratios.insert(joints[0].ratios.end(), count, 0.0);
        joints[1].ratios.insert(joints[1].ratios.begin(), count, 0.0);
        positions.insert(positions.end(), right.positions.begin(), right.positions.end());
        for (const auto& [a, b, c] : right.triangles)
            triangles.push_back({a + count, b + count, c + count});
    }

    static ElasticJoint jointOf(const ElasticTube& tube) { return tube.joint({-25, 25, 50}); }

    /// \return the number of progress reports
    std::size_t solve() {
        std::size_t told = 0;
        shapes = solveElasticJoints({positions, triangles}, joints,
                                    [&told](const ProgressStep&) { ++told; });
        return told;
    }

    ElasticTube left{1.0, kLeft}, right{1.0, kRight};
    std::vector<glm::dvec3> positions = left.positions;
    std::vector<std::array<std::uint32_t, 3>> triangles = left.triangles;
    std::vector<ElasticJoint> joints;
    std::vector<ElasticShapes> shapes;
};

} // namespace

TEST_F(ElasticMirror, OneSideIsSolvedAndServesBoth) {
    EXPECT_LE(solve(), 3u) << "samples of one joint";
    const ElasticShapes& solved = shapes[0];
    const ElasticShapes& other = shapes[1];
    ASSERT_EQ(other.reason, "");
    EXPECT_EQ(other.seconds, 0.0);
    ASSERT_EQ(other.samples.size(), 3u);
    EXPECT_GT(other.vertices.size(), solved.vertices.size() * 9 / 10);
    const ElasticShapes alone = solveElasticJoint({positions, triangles}, joints[1]);
    double moved = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
        EXPECT_EQ(other.samples[s].rotation, joints[1].samples[s]);
        ASSERT_EQ(other.samples[s].positions.size(), other.vertices.size());
        for (std::size_t i = 0; i < other.vertices.size(); ++i) {
            const std::uint32_t v = other.vertices[i];
            EXPECT_EQ(other.rest[i], positions[v]);
            const auto found = std::lower_bound(alone.vertices.begin(), alone.vertices.end(), v);
            ASSERT_TRUE(found != alone.vertices.end() && *found == v);
            const auto at = static_cast<std::size_t>(found - alone.vertices.begin());
            EXPECT_LT(glm::distance(other.samples[s].positions[i], alone.samples[s].positions[at]),
                      5e-3);
            moved = std::max(moved, glm::distance(other.samples[s].positions[i], other.rest[i]));
        }
    }
    EXPECT_GT(moved, 1.0);
}

TEST_F(ElasticMirror, SamplesOfTheOtherSideMayComeInAnotherOrder) {
    std::swap(joints[1].samples[0], joints[1].samples[2]);
    EXPECT_LE(solve(), 3u);
    for (std::size_t s = 0; s < 3; ++s)
        EXPECT_EQ(shapes[1].samples[s].rotation, joints[1].samples[s]);
    const glm::dvec3 top = shapes[0].samples[0].positions.back();
    const auto& positionsOfOther = shapes[1].samples[2].positions;
    EXPECT_TRUE(
        std::any_of(positionsOfOther.begin(), positionsOfOther.end(),
                    [&](const glm::dvec3& p) { return glm::distance(p, mirrored(top)) < 0.05; }));
}

TEST_F(ElasticMirror, BothSidesAreSolvedWhereSomethingDiffers) {
    using Joint = ElasticJoint;
    using Skin = std::vector<glm::dvec3>;
    const struct {
        const char* what;
        void (*change)(Joint& joint, Skin& skin);
    } cases[] = {
        {"a bone", [](Joint& joint, Skin&) { joint.bones[1].to.z += 0.5; }},
        {"what a bone follows", [](Joint& joint, Skin&) { joint.bones[0].moves = true; }},
        {"a sample", [](Joint& joint, Skin&) { joint.samples[0] = glm::dquat(1, 0, 0, 0); }},
        {"the radius", [](Joint& joint, Skin&) { joint.radius *= 1.2; }},
        {"ratios",
         [](Joint& joint, Skin&) {
             for (double& ratio : joint.ratios) ratio *= 0.8;
         }},
        {"the skin",
         [](Joint& joint, Skin& skin) {
             for (glm::dvec3& p : skin)
                 if (p.x < 1.0) p.z = joint.centre.z + 1.2 * (p.z - joint.centre.z);
         }},
    };
    for (const auto& each : cases) {
        const auto before = std::make_pair(joints, positions);
        each.change(joints[1], positions);
        solve();
        EXPECT_GT(shapes[1].seconds, 0.0) << each.what;
        std::tie(joints, positions) = before;
    }
}

TEST(ElasticSkin, MayBeOpenAtItsEnds) {
    const ElasticTube open(1.0, glm::dvec3(0.0), false), closed;
    const ElasticShapes a = solveElasticJoint(open.skin(), open.joint({45}));
    const ElasticShapes b = solveElasticJoint(closed.skin(), closed.joint({45}));
    ASSERT_EQ(a.reason, "");
    ASSERT_EQ(a.vertices, b.vertices); // the caps are out of reach
    for (std::size_t v = 0; v < a.vertices.size(); ++v)
        EXPECT_LT(glm::length(a.samples[0].positions[v] - b.samples[0].positions[v]), 0.02);
}

TEST(ElasticSkin, MayWindInwards) {
    ElasticTube inwards;
    for (auto& triangle : inwards.triangles) std::swap(triangle[0], triangle[1]);
    const ElasticShapes shapes = solveElasticJoint(inwards.skin(), inwards.joint({60, 120}));
    ASSERT_EQ(shapes.reason, "");
    EXPECT_EQ(shapes.samples[1].crossings, 0u);
    EXPECT_GT(shapes.samples[1].plainCrossings, 0u);
}

// A sleeve around the tube, which has no interior of its own, moves with the flesh below it.
TEST(ElasticSkin, CarriesEveryShell) {
    ElasticTube dressed;
    const std::size_t skinOnly = dressed.positions.size();
    const ElasticTube sleeve(1.05, glm::dvec3(0.0), false);
    dressed.positions.insert(dressed.positions.end(), sleeve.positions.begin(),
                             sleeve.positions.end());
    for (auto triangle : sleeve.triangles) {
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(skinOnly);
        dressed.triangles.push_back(triangle);
    }
    const ElasticShapes shapes = solveElasticJoint(dressed.skin(), dressed.joint({60}));
    ASSERT_EQ(shapes.reason, "");
    std::size_t carried = 0;
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (shapes.vertices[i] < skinOnly) continue;
        ++carried;
        double nearest = 1e9; // to the tube's own vertices, which are 0.3 apart
        for (std::size_t k = 0; k < shapes.vertices.size(); ++k)
            if (shapes.vertices[k] < skinOnly)
                nearest = std::min(nearest, glm::length(shapes.samples[0].positions[i] -
                                                        shapes.samples[0].positions[k]));
        EXPECT_LT(nearest, 0.35);
    }
    EXPECT_GT(carried, 300u);
}

// Two tubes a tenth of a radius apart do not merge: the one that is not bent stays.
TEST(ElasticSkin, LeavesAloneWhatOnlyLiesBeside) {
    ElasticTube two;
    const std::size_t one = two.positions.size();
    const ElasticTube other(1.0, glm::dvec3(2.1, 0, 0));
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    for (auto triangle : other.triangles) {
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(one);
        two.triangles.push_back(triangle);
    }
    ElasticJoint joint = two.joint({60});
    std::fill(joint.ratios.begin() + static_cast<std::ptrdiff_t>(one), joint.ratios.end(), 0.0);
    const ElasticShapes shapes = solveElasticJoint(two.skin(), joint);
    ASSERT_EQ(shapes.reason, "");
    EXPECT_GT(shapes.vertices.size(), 300u);
    EXPECT_LT(shapes.vertices.back(), one) << "the other tube hangs on";
}

TEST(ElasticSkin, SaysWhyAJointIsNotSolved) {
    const ElasticTube tube;
    struct Case {
        const char* name;
        ElasticJoint joint;
        const char* reason;
    };
    std::vector<Case> cases(4, {"", tube.joint({45, 60}), ""});
    cases[0].name = "no radius";
    cases[0].joint.radius = 0.0;
    cases[0].reason = "its limb has no radius";
    cases[1].name = "elsewhere";
    cases[1].joint.centre = glm::dvec3(50, 0, 0);
    cases[1].reason = "there is no skin around the joint";
    cases[2].name = "wide";
    cases[2].joint.radius = 5.0;
    cases[2].reason = "its limbs end within reach";
    cases[3].name = "ratios of another skin";
    cases[3].joint.ratios.pop_back();
    cases[3].reason = "it needs one ratio for each vertex";
    for (const Case& each : cases) {
        double share = 0.0;
        const ElasticShapes shapes = solveElasticJoint(
            tube.skin(), each.joint, [&share](const ProgressStep& step) { share = step.fraction; });
        EXPECT_EQ(shapes.reason, each.reason) << each.name;
        EXPECT_TRUE(shapes.samples.empty()) << each.name;
        EXPECT_DOUBLE_EQ(share, 1.0) << each.name;
    }
}

TEST(ElasticSkin, WithoutTrianglesIsNotSolved) {
    const ElasticTube tube;
    const std::vector<std::array<std::uint32_t, 3>> none;
    EXPECT_EQ(solveElasticJoint({tube.positions, none}, tube.joint({30})).reason,
              "the skin has no triangles");
}

TEST(ElasticSkin, TellsHowFarItIsAndGivesUpWhenTold) {
    const ElasticTube tube;
    const std::vector<ElasticJoint> joints(2, tube.joint({10, -10, 20}));
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<double> fractions;
    solveElasticJoints(tube.skin(), joints, [&](const ProgressStep& step) {
        EXPECT_EQ(step.what, "tube");
        EXPECT_EQ(std::this_thread::get_id(), caller);
        fractions.push_back(step.fraction);
    });
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.front(), 0.0);
    EXPECT_DOUBLE_EQ(fractions.back(), 1.0);

    int calls = 0;
    EXPECT_THROW(solveElasticJoints(tube.skin(), joints,
                                    [&calls](const ProgressStep&) {
                                        ++calls;
                                        throw std::runtime_error("enough");
                                    }),
                 std::runtime_error);
    EXPECT_EQ(calls, 1);
}

namespace {

/// Merges corners at the same position.
std::vector<std::array<std::uint32_t, 3>> weldedTriangles(const SkinMesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        first.push_back(known.try_emplace({p.x, p.y, p.z}, v).first->second);
    }
    const std::vector<std::uint32_t> corners = mesh.triangles();
    std::vector<std::array<std::uint32_t, 3>> result;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
        result.push_back({first[corners[t]], first[corners[t + 1]], first[corners[t + 2]]});
    return result;
}

} // namespace

TEST(RealElastic, ElbowFoldsWithoutCrossings) {
    const auto body = shared::makehuman() / "body/body4k_neutral.obj";
    if (!std::filesystem::exists(body)) GTEST_SKIP() << body << " is not here";
    const SkinMesh mesh = shared::readObj(body);
    const RestSkeleton rig =
        shared::readJoints(shared::makehuman() / "rig/joints_cmu_mb_neutral.json");
    const Binding binding = bind(mesh, rig);
    const auto elbow = static_cast<std::size_t>(rig.find("LeftForeArm"));
    const glm::dvec3 centre = rig.joints[elbow].centre, pole = binding.joints[elbow].boneAxis;
    const glm::dvec3 shoulder =
        rig.joints[static_cast<std::size_t>(rig.joints[elbow].parent)].centre;
    const glm::dvec3 hand = rig.joints[static_cast<std::size_t>(rig.find("LeftHand"))].centre;

    ElasticJoint joint;
    joint.name = "LeftForeArm";
    joint.centre = centre;
    joint.radius = 0.386; // where the bend is halfway
    joint.hinge = true;
    joint.bones = {{shoulder, centre, false}, {centre, hand, true}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        double ratio = 0.0;
        for (std::size_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == elbow) ratio = double(binding.influences[i].bend);
        joint.ratios.push_back(ratio);
    }
    const glm::dvec3 above = glm::normalize(centre - shoulder);
    const glm::dvec3 axis = glm::normalize(glm::cross(above, pole));
    const double rest = std::acos(glm::dot(above, pole));
    for (const double total : {129.0, 139.0})
        joint.samples.push_back(glm::angleAxis(glm::radians(total) - rest, axis));

    const auto triangles = weldedTriangles(mesh);
    const ElasticShapes shapes = solveElasticJoint({mesh.positions, triangles}, joint);
    ASSERT_EQ(shapes.reason, "");
    for (const ElasticSample& sample : shapes.samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_LE(10 * sample.crossings, sample.plainCrossings);
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_GT(sample.volumeRatio, 0.95);
    }
    EXPECT_GT(shapes.samples.back().plainCrossings, 20u);

    // Vertices out of the elbow's reach, and the hand's, move with their bones.
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (glm::length(shapes.rest[i] - centre) < 0.97 * shapes.reach) continue;
        const glm::dvec3 turned =
            centre + glm::mat3_cast(shapes.samples[0].rotation) * (shapes.rest[i] - centre);
        const glm::dvec3 expected =
            joint.ratios[shapes.vertices[i]] > 0.5 ? turned : shapes.rest[i];
        EXPECT_LT(glm::length(shapes.samples[0].positions[i] - expected), 0.02 * joint.radius);
    }
}

namespace {

const std::string kDigest = digestOf("what they are made of");

/// Two vertices below a root and one joint.
Binding someBinding() {
    Binding binding;
    binding.joints.resize(2);
    binding.joints[1].parent = 0;
    binding.regions = {0, 1};
    return binding;
}

MadeShapes someShapes() {
    MadeShapes shapes;
    shapes.notes = {"a line", ""};
    CorrectiveJoint& joint = shapes.correctives.joints.emplace_back();
    joint.joint = 1;
    joint.axis = {1, 0, 0};
    joint.low = {-0.5, -0.25};
    joint.high = {0.75, 0.25};
    joint.modes = 1;
    joint.coefficients = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    shapes.correctives.firstEntry = {0, 0, 1};
    shapes.correctives.entries = {{0, 0}};
    shapes.correctives.shares = {Correctives::kUnit, 0, -5};
    return shapes;
}

void replace(const std::filesystem::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

} // namespace

TEST(ShapesCache, GivesBackWhatItWasGiven) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache((scratch.path() / "a" / "b").string(), kDigest);
    EXPECT_FALSE(cache.read(someBinding(), notes));
    cache.write(someShapes(), notes);
    EXPECT_EQ(scratch.files().size(), 1u); // no temporary file remains
    const std::optional<MadeShapes> found = cache.read(someBinding(), notes);
    EXPECT_TRUE(notes.empty());
    ASSERT_TRUE(found);
    const MadeShapes expected = someShapes();
    EXPECT_EQ(found->notes, expected.notes);
    const CorrectiveJoint &joint = found->correctives.joints.at(0),
                          &known = expected.correctives.joints[0];
    EXPECT_EQ(joint.joint, known.joint);
    EXPECT_EQ(joint.basis, known.basis);
    EXPECT_EQ(joint.axis, known.axis);
    EXPECT_EQ(joint.low, known.low);
    EXPECT_EQ(joint.high, known.high);
    EXPECT_EQ(joint.modes, known.modes);
    EXPECT_EQ(joint.coefficients, known.coefficients);
    EXPECT_EQ(found->correctives.firstEntry, expected.correctives.firstEntry);
    EXPECT_EQ(found->correctives.entries.size(), 1u);
    EXPECT_EQ(found->correctives.shares, expected.correctives.shares);
}

TEST(ShapesCache, KnowsNothingOfOthers) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    ShapesCache(scratch.path().string(), kDigest).write(someShapes(), notes);
    EXPECT_NE(digestOf("something else"), kDigest);
    const ShapesCache other(scratch.path().string(), digestOf("something else"));
    EXPECT_FALSE(other.read(someBinding(), notes));
    EXPECT_TRUE(notes.empty());
}

TEST(ShapesCache, SaysSoOfAFileThatIsNoUse) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache(scratch.path().string(), kDigest);
    cache.write(someShapes(), notes);
    const std::filesystem::path file = scratch.files().at(0);
    const std::string whole = test::fileText(file);
    std::string changed = whole;
    changed[whole.size() - 3] = static_cast<char>(changed[whole.size() - 3] ^ 1);
    const std::vector<std::string> broken{
        "",          "no",    whole.substr(0, whole.size() - 1),
        whole + "x", changed, std::string("x").append(whole.substr(1))};
    for (std::size_t i = 0; i < broken.size(); ++i) {
        replace(file, broken[i]);
        notes.clear();
        EXPECT_FALSE(cache.read(someBinding(), notes)) << i;
        EXPECT_EQ(notes.size(), 1u) << i;
    }
    replace(file, whole);
    Binding smaller = someBinding();
    smaller.regions.pop_back(); // the file is complete, but for another skin
    notes.clear();
    EXPECT_FALSE(cache.read(smaller, notes));
    EXPECT_EQ(notes.size(), 1u);
}

TEST(ShapesCache, OpensNothingButFilesAsLargeAsShapesAre) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache(scratch.path().string(), kDigest);
    cache.write(someShapes(), notes);
    const std::filesystem::path file = scratch.files().at(0);
    const auto expectNoUse = [&](const char* what) {
        notes.clear();
        EXPECT_FALSE(cache.read(someBinding(), notes)) << what;
        EXPECT_EQ(notes.size(), 1u) << what;
        std::filesystem::remove(file);
    };
    std::filesystem::resize_file(file, std::uintmax_t(1) << 40); // a sparse file, without disk
                                                                 // space
    expectNoUse("a file of a terabyte");
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    expectNoUse("a pipe");
    std::filesystem::create_symlink("/dev/zero", file);
    expectNoUse("a device");
    std::filesystem::create_directory(file);
    expectNoUse("a folder");
    cache.write(someShapes(), notes);
    EXPECT_TRUE(cache.read(someBinding(), notes));
}

TEST(ShapesCache, SaysWhereItCannotWrite) {
    const ScratchFolder scratch;
    replace(scratch.path() / "file", "no folder");
    std::vector<std::string> notes;
    const ShapesCache cache((scratch.path() / "file").string(), kDigest);
    cache.write(someShapes(), notes);
    EXPECT_EQ(notes.size(), 1u);
}
