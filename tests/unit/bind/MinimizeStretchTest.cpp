// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fields for the turns that a joint makes: on a sheet, and on bodies.
#include "ratios/MinimizeStretch.h"
#include "KnownBody.h"
#include "Stretches.h"
#include "mesh/HeatGraph.h"
#include "mesh/SkinSmoother.h"
#include "mesh/WeldedMesh.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace osgSkin;

namespace {

/// A square of triangles, two units wide, about the origin in the plane z = 0.
SkinMesh sheet(std::uint32_t side) {
    SkinMesh mesh;
    const double step = 2.0 / (side - 1);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            mesh.positions.emplace_back(step * x - 1.0, step * y - 1.0, 0.0);
            if (x == 0 || y == 0) continue;
            const std::uint32_t v = y * side + x;
            for (const std::uint32_t corner : {v - side - 1, v - side, v, v - side - 1, v, v - 1})
                mesh.faceVertices.push_back(corner);
        }
    mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    return mesh;
}

/// A field that rises from left to right between -0.7 and 0.7, steepest in the middle.
struct Rise {
    WeldedMesh mesh;
    std::vector<double> field;
    std::vector<bool> isFree;

    explicit Rise(std::uint32_t side = 21) : mesh(sheet(side)) {
        for (const glm::dvec3& p : mesh.positions) {
            const double t = std::clamp(0.5 + p.x / 1.4, 0.0, 1.0);
            field.push_back(t * t * t * (10.0 + t * (6.0 * t - 15.0)));
            isFree.push_back(t > 0.0 && t < 1.0);
        }
    }

    /// Largest growth along x between neighbours around a height.
    double steepestAt(double y) const {
        const auto side = static_cast<std::size_t>(std::lround(std::sqrt(mesh.positions.size())));
        const double step = 2.0 / static_cast<double>(side - 1);
        const auto row = static_cast<std::size_t>(std::lround((y + 1.0) / step)) * side;
        double most = 0.0;
        for (std::size_t x = 1; x < side; ++x)
            most = std::max(most, (field[row + x] - field[row + x - 1]) / step);
        return most;
    }
};

/// About the sheet's middle: what is below the middle is stretched, what is above it pressed.
const std::vector<glm::dvec3> kTurn = {{0.0, 0.0, 1.5}};

} // namespace

TEST(MinimizeStretch, SpreadsWhereSkinIsStretched) {
    Rise rise;
    const double before = rise.steepestAt(-0.8);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_LT(rise.steepestAt(-0.8), 0.7 * before);
    EXPECT_GT(rise.steepestAt(0.0), 1.2 * rise.steepestAt(-0.8));
    for (const double a : rise.field) {
        EXPECT_GE(a, 0.0);
        EXPECT_LE(a, 1.0);
    }
}

TEST(MinimizeStretch, KeepsWhatIsNotFree) {
    Rise rise;
    const std::vector<double> before = rise.field;
    for (std::size_t v = 0; v < before.size(); v += 3) rise.isFree[v] = false;
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_NE(rise.field, before);
    for (std::size_t v = 0; v < before.size(); ++v)
        if (!rise.isFree[v]) {
            EXPECT_EQ(rise.field[v], before[v]) << v;
        }
    rise.field = before;
    rise.isFree.assign(before.size(), false);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_EQ(rise.field, before);
}

TEST(MinimizeStretch, IsNearlyTheSameOnACoarserCopy) {
    Rise fine(121);
    const std::vector<double> before = fine.field;
    Rise whole = fine;
    minimizeStretch(HeatGraph(whole.mesh), whole.field, whole.isFree, glm::dvec3(0.0), kTurn);
    const SkinSmoother smoother(fine.mesh, 0.7);
    std::size_t vertices = 0;
    smoother.change(fine.field, fine.isFree, 0.7,
                    [&vertices](const HeatGraph& skin, std::vector<double>& field,
                                const std::vector<bool>& isFree) {
                        vertices = field.size();
                        minimizeStretch(skin, field, isFree, glm::dvec3(0.0), kTurn);
                    });
    EXPECT_LT(vertices, fine.field.size() / 3);
    double most = 0.0, moved = 0.0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        most = std::max(most, std::abs(fine.field[v] - whole.field[v]));
        moved = std::max(moved, std::abs(whole.field[v] - before[v]));
        if (!fine.isFree[v]) {
            EXPECT_EQ(fine.field[v], before[v]) << v;
        }
    }
    EXPECT_GT(moved, 0.1);
    EXPECT_LT(most, 0.5 * moved);
}

TEST(UnseenBodies, ArmsThatReachForwardsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = neutral.posed(
        {{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)},
         {"RightArm",
          glm::angleAxis(glm::radians(80.0), glm::dvec3(forwards.x, -forwards.y, -forwards.z))}});
    const std::vector<double> sorted = stretches(neutral.mesh, posed.mesh);
    EXPECT_LT(percentile999(sorted), 1.52); // 1.55 where swings do not count
    EXPECT_LT(sorted.back(), 1.60);         // 1.67
}

/// A pad over the shoulder, which nothing holds, keeps the field that it had.
TEST(UnseenBodies, PadsOnTheShoulderStayOnIt) {
    KnownBody body = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (body.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 shoulder =
        body.truth.joints.at(std::size_t(body.truth.find("LeftArm"))).centre;
    const std::vector<glm::dvec3> skin = body.mesh.positions;
    const double height = glm::distance(shoulder, body.truth.joints.front().centre) * 3.0;
    // Where each vertex of the pad comes from; away from the joint by a hundredth of the height.
    std::vector<std::uint32_t> padOf(skin.size(), 0), below;
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const auto isNear = [&](std::uint32_t v) {
            return glm::distance(skin[v], shoulder) < 0.045 * height;
        };
        if (!std::all_of(corners.begin() + std::ptrdiff_t(t),
                         corners.begin() + std::ptrdiff_t(t + 3), isNear))
            continue;
        for (std::size_t c = t; c < t + 3; ++c) {
            const std::uint32_t v = corners[c];
            if (padOf[v] == 0) {
                padOf[v] = static_cast<std::uint32_t>(body.mesh.positions.size());
                below.push_back(v);
                body.mesh.positions.push_back(skin[v] +
                                              0.01 * height * glm::normalize(skin[v] - shoulder));
            }
            body.mesh.faceVertices.push_back(padOf[v]);
        }
        body.mesh.faceSizes.push_back(3);
    }
    ASSERT_GT(below.size(), 30u);
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = body.posed({{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)}});
    double farthest = 0.0;
    for (std::size_t i = 0; i < below.size(); ++i)
        farthest = std::max(farthest, glm::distance(posed.mesh.positions[skin.size() + i],
                                                    posed.mesh.positions[below[i]]));
    EXPECT_LT(farthest, 0.02 * height); // 0.03 where it is drawn out
}
