// SPDX-License-Identifier: MIT
// One shape, or several, for surfaces whose best ones are known.
#include "hits/FitShapes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using osgSkin::HitBoxes;
using osgSkin::LimbSurface;
using Kind = HitBoxes::Shape::Kind;

/// Points of a box's faces, with the edges of their grids, rotated and moved.
void addBox(const glm::dvec3& half, const glm::dvec3& centre, const glm::dquat& rotation,
            LimbSurface& surface) {
    constexpr int n = 8;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<std::uint32_t>(surface.points.size());
            for (int i = 0; i <= n; ++i)
                for (int k = 0; k <= n; ++k) {
                    glm::dvec3 p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = 2.0 * i / n - 1.0;
                    p[(axis + 2) % 3] = 2.0 * k / n - 1.0;
                    surface.points.push_back(centre + rotation * (p * half));
                    const auto at = first + static_cast<std::uint32_t>(i * (n + 1) + k);
                    if (k > 0) surface.edges.push_back({at - 1, at});
                    if (i > 0) surface.edges.push_back({at - n - 1, at});
                }
        }
}

const glm::dquat kTurned = glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 3)));

double sumOf(const std::vector<HitBoxes::Shape>& shapes) {
    double sum = 0.0;
    for (const HitBoxes::Shape& shape : shapes) sum += shape.volume();
    return sum;
}

} // namespace

TEST(FitShapes, FindsABox) {
    LimbSurface surface;
    addBox({0.1, 0.2, 0.6}, {1, 2, 3}, kTurned, surface);
    osgSkin::HitBoxes::Options options;
    options.inside = 1.0;
    const HitBoxes::Shape box = osgSkin::fitShapes({surface}, 1e9, options)[0].at(0);
    EXPECT_EQ(box.kind, Kind::Box);
    EXPECT_NEAR(box.volume(), 8 * 0.1 * 0.2 * 0.6, 0.05 * 8 * 0.1 * 0.2 * 0.6);
    EXPECT_LT((box.frame.getTrans() - osg::Vec3d(1, 2, 3)).length(), 0.01);
}

TEST(FitShapes, FindsACapsule) {
    LimbSurface surface;
    for (int i = 0; i <= 20; ++i)
        for (int k = 0; k < 24; ++k) {
            const double along = 1.4 * i / 20 - 0.7, round = glm::two_pi<double>() * k / 24;
            const double over = std::max(0.0, std::abs(along) - 0.5);
            const double radius = std::sqrt(0.04 - over * over);
            surface.points.push_back(
                kTurned * glm::dvec3(radius * std::cos(round), radius * std::sin(round), along));
        }
    const HitBoxes::Shape capsule = osgSkin::fitShape(surface, 1.0);
    EXPECT_EQ(capsule.kind, Kind::Capsule);
    EXPECT_NEAR(capsule.half.x(), 0.2, 0.005);
    EXPECT_NEAR(capsule.half.z(), 0.5, 0.01);
    const osg::Vec3d z(capsule.frame(2, 0), capsule.frame(2, 1), capsule.frame(2, 2));
    const glm::dvec3 expected = kTurned * glm::dvec3(0, 0, 1);
    EXPECT_GT(std::abs(z * osg::Vec3d(expected.x, expected.y, expected.z)), 0.999);
}

TEST(FitShapes, LeavesOutliersOut) {
    LimbSurface surface;
    addBox({0.1, 0.2, 0.6}, {}, {1, 0, 0, 0}, surface);
    const double plain = osgSkin::fitShape(surface, 1.0).volume();
    for (const glm::dvec3& far : {glm::dvec3(2, 0, 0), {0, 3, 0}, {0, 0, -4}})
        surface.points.push_back(far);
    EXPECT_GT(osgSkin::fitShape(surface, 1.0).volume(), 10.0 * plain);
    EXPECT_LE(osgSkin::fitShape(surface, 0.99).volume(), 1.2 * plain);
}

TEST(FitShapes, DividesIntoSlices) {
    LimbSurface surface; // a hammer
    addBox({0.1, 0.1, 0.5}, {0, 0, -0.5}, {1, 0, 0, 0}, surface);
    addBox({0.1, 0.6, 0.1}, {0, 0, 0.1}, {1, 0, 0, 0}, surface);
    const double volume = 8 * (0.1 * 0.1 * 0.5 + 0.1 * 0.6 * 0.1);
    HitBoxes::Options options;
    options.inside = 1.0;
    options.maxShapes = 1;
    const auto whole = osgSkin::fitShapes({surface}, volume, options);
    ASSERT_EQ(whole[0].size(), 1u);
    EXPECT_GT(sumOf(whole[0]), 1.8 * volume);
    options.maxShapes = 4;
    const auto divided = osgSkin::fitShapes({surface}, volume, options);
    EXPECT_GE(divided[0].size(), 2u);
    EXPECT_LE(divided[0].size(), 4u);
    EXPECT_LT(sumOf(divided[0]), 1.4 * volume);
    EXPECT_GT(sumOf(divided[0]), 0.95 * volume) << "not hollow";
    EXPECT_EQ(osgSkin::fitShapes({surface}, 1e9, options)[0].size(), 1u) << "small enough";
}
