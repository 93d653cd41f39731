// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/PaperFields.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace osgSkin;

namespace {

/// A point between two planes: its distance below the upper and above the lower one, and their unit
/// normals, both pointing to the lower side.
struct Wedge {
    double a, b;
    glm::dvec3 upper, lower;

    /// Length of the segment through the point along `d`; infinite if it does not meet both planes.
    double length(const glm::dvec3& d) const {
        const double down = glm::dot(d, upper), on = glm::dot(d, lower);
        return down > 0.0 && on > 0.0 ? a / down + b / on : INFINITY;
    }
    double share(const glm::dvec3& d) const { return a / glm::dot(d, upper) / length(d); }
    double angle() const {
        return std::atan2(glm::length(glm::cross(upper, lower)), glm::dot(upper, lower));
    }
};

/// The direction of the shortest segment by search over all directions.
glm::dvec3 shortest(const Wedge& wedge) {
    glm::dvec3 best = glm::normalize(wedge.upper + wedge.lower);
    for (double step = 0.5; step > 1e-9; step *= 0.7)
        for (bool better = true; better;) {
            better = false;
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    for (int z = -1; z <= 1; ++z) {
                        const glm::dvec3 d = glm::normalize(best + step * glm::dvec3(x, y, z));
                        if (wedge.length(d) < wedge.length(best)) best = d, better = true;
                    }
        }
    return best;
}

class Philo : public testing::Test {
protected:
    std::mt19937 random{7};
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    }
};

} // namespace

TEST_F(Philo, IsTheShortestSegmentThroughThePoint) {
    for (int i = 0; i < 300; ++i) {
        const Wedge wedge{std::exp(between(-4, 4)), std::exp(between(-4, 4)), direction(),
                          direction()};
        if (wedge.angle() > 2.9) continue; // nearly a half space: the search itself is inaccurate
        EXPECT_NEAR(philoShare(wedge.a, wedge.b, wedge.angle()), wedge.share(shortest(wedge)), 1e-5)
            << wedge.a << ' ' << wedge.b << ' ' << wedge.angle();
    }
}

TEST_F(Philo, IsPerpendicularBetweenParallelPlanes) {
    EXPECT_EQ(philoShare(1.0, 3.0, 0.0), 0.25);
    for (const double angle : {1e-12, 1e-9, 1e-7, 1e-5})
        EXPECT_NEAR(philoShare(1.0, 3.0, angle), 0.25, 1e-9) << angle;
}

TEST_F(Philo, IsHalfInTheMiddle) {
    for (double angle = 0.0; angle < 3.1; angle += 0.1)
        EXPECT_NEAR(philoShare(2.0, 2.0, angle), 0.5, 1e-12) << angle;
}

TEST_F(Philo, IsSymmetricInThePlanes) {
    for (int i = 0; i < 1000; ++i) {
        const double a = between(0, 5), b = between(0, 5), angle = between(0, 3.1);
        EXPECT_NEAR(philoShare(a, b, angle), 1.0 - philoShare(b, a, angle), 1e-10);
    }
}

TEST_F(Philo, DoesNotDependOnUnits) {
    for (const double unit : {1e-9, 1e-3, 1e3, 1e9})
        EXPECT_NEAR(philoShare(unit, 2.0 * unit, 0.7), philoShare(1.0, 2.0, 0.7), 1e-12) << unit;
}

TEST_F(Philo, GrowsFromTheUpperPlaneToTheLower) {
    for (const double angle : {0.0, 0.3, 1.0, 1.5707963, 2.5, 3.1}) {
        EXPECT_EQ(philoShare(0.0, 1.0, angle), 0.0);
        EXPECT_EQ(philoShare(1.0, 0.0, angle), 1.0);
        double last = 0.0;
        for (double s = 0.001; s < 1.0; s += 0.001) {
            const double here = philoShare(s, 1.0 - s, angle);
            EXPECT_GT(here, last) << angle << ' ' << s;
            last = here;
        }
        EXPECT_LT(last, 1.0);
    }
}

TEST_F(Philo, ExtremesStayInRange) {
    for (const double a : {1e-300, 1e-30, 1e-12, 1.0, 1e12, 1e30})
        for (const double b : {1e-300, 1e-30, 1e-12, 1.0, 1e12, 1e30})
            for (const double angle :
                 {0.0, 1e-15, 1e-8, 1.5707963267948966, 3.1415, 3.14159265, 3.141592653589793}) {
                const double share = philoShare(a, b, angle);
                EXPECT_GE(share, 0.0) << a << ' ' << b << ' ' << angle;
                EXPECT_LE(share, 1.0) << a << ' ' << b << ' ' << angle;
            }
}
