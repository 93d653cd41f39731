// SPDX-License-Identifier: GPL-3.0-or-later
#include "arms/BodySurface.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

using osgSkin::SkinPoints;

namespace {

/// Points of two joints by turns, of the first around (0, 0, 0) and (4, 0, 0), of the second around
/// the same places 2 higher; a bump in the middle of each.
SkinPoints bumps() {
    SkinPoints points;
    for (int ring = 0; ring < 8; ++ring)
        for (const double x : {0.0, 4.0})
            for (const std::uint32_t joint : {0u, 1u}) {
                const double angle = 0.25 * M_PI * ring;
                const glm::dvec3 around(0.5 * std::cos(angle), 2.0 * joint, 0.5 * std::sin(angle));
                points.add(around + glm::dvec3(x, 0.4 * (ring % 2), 0), {0, 1, 0}, joint);
            }
    return points;
}

} // namespace

TEST(SkinPoints, AreAveragedOverAllThatMoveAlike) {
    const SkinPoints points = bumps();
    const SkinPoints averaged = points.averaged(4);
    ASSERT_EQ(averaged.size(), 4u);
    std::size_t of[2] = {0, 0};
    for (std::size_t k = 0; k < averaged.size(); ++k) {
        const std::uint32_t joint = averaged.joints[k];
        ++of[joint];
        const double x = averaged.places[k].x < 2.0 ? 0.0 : 4.0;
        EXPECT_LT(glm::distance(averaged.places[k], glm::dvec3(x, 2.0 * joint + 0.2, 0)), 1e-12)
            << k;
        EXPECT_NEAR(averaged.normals[k].y, 1.0, 1e-12);
    }
    EXPECT_EQ(of[0], 2u);
    EXPECT_EQ(of[1], 2u);
}

TEST(SkinPoints, AreAllKeptWhereThereAreFew) {
    const SkinPoints points = bumps();
    EXPECT_EQ(points.spread(points.size()).places, points.places);
    EXPECT_EQ(points.spread(5).size(), 5u);
}
