// SPDX-License-Identifier: GPL-3.0-or-later
// Skins and joints that are not one closed tube in its prime.
#include "ElasticTube.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <stdexcept>
#include <thread>

using namespace osgSkin;

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

// A sleeve around the tube, which has no inside of its own, moves with the flesh below it.
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

// Two tubes a tenth of a radius apart do not grow together: the one that is not bent stays.
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
