// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/NearestPoints.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

using namespace osgSkin;

namespace {

using Indices = std::vector<std::uint32_t>;

/// Brute force; the first of equally near points.
Indices byTrying(const std::vector<glm::dvec3>& points, const Indices& candidates,
                 const Indices& queries) {
    Indices result;
    for (const std::uint32_t q : queries) {
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t best = 0;
        for (const std::uint32_t c : candidates) {
            const glm::dvec3 d = points[c] - points[q];
            if (glm::dot(d, d) > least || (glm::dot(d, d) == least && c > best)) continue;
            least = glm::dot(d, d);
            best = c;
        }
        result.push_back(best);
    }
    return result;
}

struct Case {
    const char* name;
    double step; ///< coordinates are multiples of it; 0: any
};

class NearestPointsAmong : public testing::TestWithParam<Case> {};

TEST_P(NearestPointsAmong, MatchBruteForce) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto coordinate = [&] {
        const double x = uniform(random);
        return GetParam().step > 0.0 ? GetParam().step * std::round(x / GetParam().step) : x;
    };
    std::vector<glm::dvec3> points(2000);
    for (glm::dvec3& p : points) p = {coordinate(), coordinate(), coordinate()};
    Indices all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    std::shuffle(all.begin(), all.end(), random);
    const Indices candidates(all.begin(), all.begin() + 1500);
    const Indices queries(all.begin() + 1000, all.end()); // including candidates, which are nearest
                                                          // to themselves
    EXPECT_EQ(osgSkin::nearestPoints(points, candidates, queries),
              byTrying(points, candidates, queries));
}

INSTANTIATE_TEST_SUITE_P(Points, NearestPointsAmong,
                         testing::Values(Case{"Anywhere", 0.0}, Case{"OnAGridWithManyTies", 0.25},
                                         Case{"OnAGridThatIsNotExact", 0.1},
                                         Case{"InOnePoint", 10.0}),
                         [](const auto& each) { return each.param.name; });

TEST(NearestPoints, TieGoesToTheLowestIndex) {
    const std::vector<glm::dvec3> points = {
        {0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    EXPECT_EQ(osgSkin::nearestPoints(points, {4, 3, 2, 1}, {0}), Indices{1});
    EXPECT_EQ(osgSkin::nearestPoints(points, {4, 2, 3}, {0, 1}), (Indices{2, 3}));
}

TEST(NearestPoints, SingleCandidate) {
    EXPECT_EQ(osgSkin::nearestPoints({{0, 0, 0}, {5, 0, 0}}, {1}, {0, 1}), (Indices{1, 1}));
    EXPECT_EQ(osgSkin::nearestPoints({{0, 0, 0}, {5, 0, 0}}, {1}, {}), Indices{});
}

} // namespace
