// SPDX-License-Identifier: GPL-3.0-or-later
#include "PeakMemory.h"
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkin/SkinModel>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>

using namespace osgSkin;

namespace {

/// A cylinder over three joints; each joint's painted weights take over from the one above.
struct PaintedCylinder {
    SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 4.0, 6.0}, 7.0);
    VertexWeights weights;

    PaintedCylinder() {
        for (const glm::dvec3& p : mesh.positions) {
            const double first = std::clamp((p.y - 3.0) / 2.0, 0.0, 1.0);
            const double second = std::clamp((p.y - 4.0) / 2.0, 0.0, first);
            weights.push_back({{0, 1.0 - first}, {2, second}, {1, first - second}});
        }
    }
    Binding bind(BindReport* report = nullptr) const {
        return bindWeights(mesh, skeleton, weights, {}, report);
    }
};

} // namespace

TEST(BindWeights, RatioIsTheShareOfTheSubtree) {
    const PaintedCylinder input;
    const Binding binding = input.bind();
    expectSound(binding);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double y = input.mesh.positions[v].y;
        const double first = std::clamp((y - 3.0) / 2.0, 0.0, 1.0);
        const double second = std::clamp((y - 4.0) / 2.0, 0.0, first);
        EXPECT_NEAR(ratiosOf(binding, v, 1).bend, first, 1e-4) << "at " << y;
        EXPECT_NEAR(ratiosOf(binding, v, 2).bend, second, 1e-4) << "at " << y;
        EXPECT_EQ(ratiosOf(binding, v, 1).bend, ratiosOf(binding, v, 1).twist);
    }
}

/// Two equal chains side by side, as control rigs have them; the joints' indices begin at 1.
TEST(BindWeights, SharedByBranchesAreNotFollowedTwice) {
    for (const int length : {3, 6}) {
        SkinMesh mesh = shapes::cylinder();
        RestSkeleton skeleton;
        skeleton.add("root", -1, glm::dvec3(0.0));
        for (const int chain : {0, 1})
            for (int j = 0; j < length; ++j)
                skeleton.add("c" + std::to_string(chain) + std::to_string(j),
                             j == 0 ? 0 : chain * length + j, glm::dvec3(0.0, 1.0 + 0.5 * j, 0.0));
        const auto tips = [&](double share) {
            return VertexWeights(mesh.positions.size(),
                                 {{static_cast<std::uint32_t>(length), 1.0 - share},
                                  {static_cast<std::uint32_t>(2 * length), share}});
        };
        BindReport report;
        const Binding half = bindWeights(mesh, skeleton, tips(0.5), {}, &report);
        const Binding third = bindWeights(mesh, skeleton, tips(1.0 / 3.0));
        // Eight ratios may be partial; else the smaller weight is left out.
        const bool isWhole = length == 3;
        EXPECT_EQ(report.cappedVertices, isWhole ? 0 : mesh.positions.size());
        for (const std::size_t j : {std::size_t(1), std::size_t(length)}) {
            const std::size_t twin = j + std::size_t(length);
            EXPECT_NEAR(ratiosOf(half, 0, j).bend + ratiosOf(half, 0, twin).bend, 1.0, 1e-6);
            EXPECT_NEAR(ratiosOf(third, 0, j).bend, isWhole ? 2.0 / 3.0 : 1.0, 1e-6);
            EXPECT_NEAR(ratiosOf(third, 0, twin).bend, isWhole ? 1.0 / 3.0 : 0.0, 1e-6);
        }
    }
}

/// As the middle of a skirt while the figure sits down.
TEST(BindWeights, SkinBetweenTwoLegsThatBendAlikeFollowsThemAsOne) {
    const SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton;
    skeleton.add("hips", -1, glm::dvec3(0.0, 8.0, 0.0));
    for (const int leg : {0, 3})
        for (int j = 0; j < 3; ++j)
            skeleton.add("leg" + std::to_string(leg + j), j == 0 ? 0 : leg + j,
                         glm::dvec3(leg == 0 ? 0.5 : -0.5, 7.0 - 2.5 * j, 0.0));
    std::vector<glm::dmat4> posed(7, glm::dmat4(1.0));
    for (const std::size_t leg : {1u, 4u})
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3 centre = skeleton.joints[leg + j].centre;
            const glm::dmat4 turn =
                glm::rotate(glm::dmat4(1.0), j == 0 ? -1.5 : 0.8, glm::dvec3(1.0, 0.0, 0.0));
            posed[leg + j] = posed[j == 0 ? 0 : leg + j - 1] *
                             glm::translate(glm::dmat4(1.0), centre) * turn *
                             glm::translate(glm::dmat4(1.0), -centre);
        }
    const auto skirt = [&](double left) {
        VertexWeights weights;
        for (const glm::dvec3& p : mesh.positions) {
            std::vector<JointWeight> list = {{0, p.y > 7.0 ? 1.0 : 0.0}};
            const double below = std::clamp(7.0 - p.y, 0.0, 7.0) / 2.5;
            for (std::uint32_t j = 0; j < 3; ++j) {
                const double own = std::max(0.0, 1.0 - std::abs(below - j - 0.5));
                list.push_back({1 + j, left * own});
                list.push_back({4 + j, (1.0 - left) * own});
            }
            weights.push_back(list);
        }
        return deform(bindWeights(mesh, skeleton, weights, {}), mesh.positions, posed);
    };
    const auto one = skirt(1.0), half = skirt(0.5), third = skirt(1.0 / 3.0);
    for (std::size_t v = 0; v < one.size(); ++v) {
        EXPECT_LT(glm::distance(half[v], one[v]), 1e-4) << v;
        EXPECT_LT(glm::distance(third[v], one[v]), 1e-4) << v;
    }
}

TEST(BindWeights, RegionIsTheHeaviestJoint) {
    const PaintedCylinder input;
    BindReport report;
    const Binding binding = input.bind(&report);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double y = input.mesh.positions[v].y;
        if (y < 3.9) {
            EXPECT_EQ(binding.regions[v], 0u) << "at " << y;
        }
        if (y > 5.2) {
            EXPECT_EQ(binding.regions[v], 2u) << "at " << y;
        }
    }
    EXPECT_EQ(report.vertices, input.mesh.positions.size());
    EXPECT_EQ(report.shells, 1u);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_TRUE(report.notes.empty()) << report.text();
}

/// An entry for every joint at every vertex would take 400 MB.
TEST(BindWeights, MemoryDoesNotGrowWithTheNumberOfJoints) {
    const SkinMesh mesh = shapes::cylinder(80.0);
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 40.0}, 79.0);
    while (skeleton.joints.size() < 10000) {
        RestJoint joint;
        joint.name = "j" + std::to_string(skeleton.joints.size());
        joint.parent = 0;
        joint.centre.y = 1.0;
        skeleton.joints.push_back(joint);
    }
    VertexWeights weights;
    for (const glm::dvec3& p : mesh.positions) weights.push_back({{p.y > 40.0 ? 1u : 0u, 1.0}});
    ASSERT_GT(weights.size(), 5000u);
    const auto before = peakMemory();
    const Binding binding = bindWeights(mesh, skeleton, weights);
#ifndef __SANITIZE_ADDRESS__ // the sanitizer keeps freed memory for a while
    EXPECT_LT(peakMemory() - before, 200);
#else
    static_cast<void>(before);
#endif
    EXPECT_EQ(binding.regions.front(), 0u);
    EXPECT_EQ(binding.regions.back(), 1u);
}

TEST(BindWeights, MaxInfluencesIsEnforced) {
    const PaintedCylinder input;
    BindOptions options;
    std::size_t above = 0;
    for (const std::uint32_t region : input.bind().regions) above += region + 1;
    options.maxInfluences = above;
    EXPECT_NO_THROW(bindWeights(input.mesh, input.skeleton, input.weights, options));
    options.maxInfluences = above - 1;
    EXPECT_THROW(bindWeights(input.mesh, input.skeleton, input.weights, options), Error);
}

TEST(BindWeights, WeightsAreNormalised) {
    PaintedCylinder input;
    const Binding before = input.bind();
    for (auto& vertex : input.weights)
        for (JointWeight& entry : vertex) entry.weight *= 300.0;
    const Binding after = input.bind();
    for (std::size_t v = 0; v < before.vertexCount(); ++v)
        EXPECT_NEAR(ratiosOf(before, v, 1).bend, ratiosOf(after, v, 1).bend, 1e-6);
}

TEST(BindWeights, CopiesOfAVertexMoveAlike) {
    PaintedCylinder input;
    input.mesh = shapes::exploded(input.mesh);
    input.weights = PaintedCylinder().weights;
    VertexWeights copies;
    const SkinMesh whole = shapes::cylinder();
    for (std::size_t i = 0; i < whole.faceVertices.size(); ++i) {
        copies.push_back(input.weights[whole.faceVertices[i]]);
        if (i % 2) copies.back() = {{0, 1.0}}; // the seam's copies were painted differently
    }
    input.weights = copies;
    const Binding binding = input.bind();
    for (std::size_t i = 0; i < whole.faceVertices.size(); ++i)
        for (std::size_t k = 0; k < i; k += 7)
            if (whole.faceVertices[k] == whole.faceVertices[i]) {
                ASSERT_EQ(ratiosOf(binding, i, 1).bend, ratiosOf(binding, k, 1).bend);
            }
}

TEST(BindWeights, UnpaintedSkinFollowsTheNearestPainted) {
    PaintedCylinder input;
    input.weights[20].clear();
    input.weights[21] = {{1, 0.0}};
    BindReport report;
    expectSound(input.bind(&report));
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_NE(report.notes.front().find("2 vertices"), std::string::npos) << report.notes.front();
}

TEST(BindWeights, MeshWithFewUnpaintedVerticesIsWellPainted) {
    VertexWeights weights(100, {{0, 0.5}, {1, 0.5}});
    for (std::size_t v = 0; v < 5; ++v) weights[v].clear();
    EXPECT_TRUE(isWellPainted(weights));
    for (std::size_t v = 0; v < 15; ++v) weights[v].clear();
    EXPECT_FALSE(isWellPainted(weights));
}

TEST(BindWeights, PartialInfluencesAreLimitedToFour) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1, 2, 3, 4, 5, 6, 6.5}, 7.0);
    VertexWeights weights;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        weights.push_back({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 3}, {5, 2}, {6, 1}});
    BindReport report;
    const Binding binding = bindWeights(mesh, skeleton, weights, {}, &report);
    expectSound(binding);
    EXPECT_EQ(report.cappedVertices, mesh.positions.size());
    EXPECT_EQ(partialJoints(binding, 0), 4u);
    EXPECT_EQ(ratiosOf(binding, 0, 1).bend, 1.0f); // 15/16, the least partial ratio, becomes 1
    EXPECT_EQ(ratiosOf(binding, 0, 6).bend, 0.0f); // and 1/16 to 0
}

namespace {

struct BadWeights {
    const char* name;
    std::function<void(PaintedCylinder&)> spoil;
    const char* message;
};

void PrintTo(const BadWeights& bad, std::ostream* out) {
    *out << bad.name;
}

const BadWeights kBad[] = {
    {"TooFewLists", [](PaintedCylinder& i) { i.weights.pop_back(); }, "expected one list for each"},
    {"NoLists", [](PaintedCylinder& i) { i.weights.clear(); }, "expected one list for each"},
    {"UnknownJoint",
     [](PaintedCylinder& i) {
         i.weights[5] = {{3, 1.0}};
     },
     "vertex 5: joint 3"},
    {"Negative",
     [](PaintedCylinder& i) {
         i.weights[6] = {{1, -0.1}};
     },
     "vertex 6"},
    {"NotANumber",
     [](PaintedCylinder& i) {
         i.weights[7] = {{1, std::numeric_limits<double>::quiet_NaN()}};
     },
     "vertex 7"},
    {"AllZero",
     [](PaintedCylinder& i) {
         i.weights.assign(i.weights.size(), {{1, 0.0}});
     },
     "no vertex has"},
    {"NoFace", [](PaintedCylinder& i) { i.mesh.faceSizes.clear(), i.mesh.faceVertices.clear(); },
     "no face"},
    {"NoJoint", [](PaintedCylinder& i) { i.skeleton.joints.clear(); }, "no joint"},
};

class BindWeightsError : public testing::TestWithParam<BadWeights> {};

} // namespace

TEST_P(BindWeightsError, NamesTheCause) {
    PaintedCylinder input;
    GetParam().spoil(input);
    try {
        input.bind();
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
            << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, BindWeightsError, testing::ValuesIn(kBad),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(BindWeights, RatiosOfABodyAgreeWithItsPaintedWeights) {
    const auto folder = shared::makehuman();
    const auto rig = folder / "rig" / "joints_cmu_mb_neutral.json";
    const auto paint = folder / "weights" / "body4k_weights_cmu_mb.json";
    if (!std::filesystem::exists(rig)) GTEST_SKIP() << "needs " << rig;
    const SkinMesh mesh = shared::readObj(folder / "body" / "body4k_neutral.obj");
    const RestSkeleton skeleton = shared::readJoints(rig);
    const auto painted = shared::readWeights(paint, skeleton, mesh.positions.size());
    VertexWeights weights(painted.size());
    for (std::size_t v = 0; v < painted.size(); ++v)
        for (std::uint32_t j = 0; j < painted[v].size(); ++j)
            if (painted[v][j] > 0.0) weights[v].push_back({j, painted[v][j]});
    BindReport report;
    const Binding binding = bindWeights(mesh, skeleton, weights, {}, &report);
    expectSound(binding, osgSkin::SkinModel::kMaxPartialInfluences); // at branches
    std::size_t capped = 0;
    for (std::size_t v = 0; v < painted.size(); ++v) {
        double all = 0.0, worst = 0.0;
        for (const double weight : painted[v]) all += weight;
        for (std::size_t j = 0; j < painted[v].size(); ++j) {
            double sum = 0.0;
            for (std::size_t k = j; k < painted[v].size(); ++k)
                if (skeleton.isInSubtree(static_cast<int>(k), static_cast<int>(j)))
                    sum += painted[v][k];
            worst = std::max(worst, std::abs(sum / all - double(ratiosOf(binding, v, j).bend)));
        }
        if (worst > 2e-4) ++capped; // only if there were more than 4 partial joints
    }
    EXPECT_LE(capped, report.cappedVertices);
    EXPECT_LT(static_cast<double>(capped), 0.03 * static_cast<double>(painted.size()));
}
