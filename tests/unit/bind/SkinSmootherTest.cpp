// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SkinSmoother.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace osgSkin;

namespace {

constexpr double kLength = 10.0;

/// Rings of triangles around y, radius 1, each vertex moved by up to `jitter` edge lengths.
SkinMesh tube(int sides, double jitter) {
    SkinMesh mesh;
    const double edge = glm::two_pi<double>() / sides;
    const int rings = static_cast<int>(std::lround(kLength / (edge * std::sqrt(0.75))));
    std::mt19937 random(1);
    const auto moved = [&] {
        return jitter * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    };
    const auto at = [&](int ring, int side) {
        return static_cast<std::uint32_t>(ring * sides + (side + sides) % sides);
    };
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double angle = (s + 0.5 * (r % 2) + moved()) * edge;
            const double y = kLength * (r + (r % rings == 0 ? 0.0 : moved())) / rings;
            mesh.positions.emplace_back(std::sin(angle), y, std::cos(angle));
            if (r == rings) continue;
            const int odd = r % 2;
            for (const std::uint32_t v :
                 {at(r, s), at(r, s + 1), at(r + 1, s + odd), // one up, one down
                  at(r, s), at(r + 1, s + odd), at(r + 1, s + odd - 1)})
                mesh.faceVertices.push_back(v);
        }
    mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    return mesh;
}

/// Five implicit Euler steps on a line of cells: the expected value of the tube's field at `y`.
class Line {
public:
    Line(double border, double above, double below) {
        std::vector<double> width(kCells), lower(kCells), upper(kCells);
        const double cell = kLength / kCells;
        for (std::size_t i = 0; i < kCells; ++i) {
            const bool isAbove = (static_cast<double>(i) + 0.5) * cell < border;
            width[i] = isAbove ? above : below;
            _values[i] = isAbove ? 0.0 : 1.0;
        }
        const auto between = [&](std::size_t i) {
            return 0.5 * (width[i] + width[i + 1]) / (5.0 * cell * cell);
        };
        for (int step = 0; step < 5; ++step) { // Thomas's algorithm
            std::vector<double> c(kCells), d(kCells);
            for (std::size_t i = 0; i < kCells; ++i) {
                const double left = i > 0 ? between(i - 1) : 0.0;
                const double right = i + 1 < kCells ? between(i) : 0.0;
                const double pivot = 1.0 / width[i] + left + right + (i > 0 ? left * c[i - 1] : 0);
                c[i] = -right / pivot;
                d[i] = (_values[i] / width[i] + (i > 0 ? left * d[i - 1] : 0.0)) / pivot;
            }
            for (std::size_t i = kCells; i-- > 0;)
                _values[i] = d[i] - (i + 1 < kCells ? c[i] * _values[i + 1] : 0.0);
        }
    }
    double at(double y) const {
        const double cell = std::clamp(y / kLength * kCells - 0.5, 0.0, kCells - 1.0);
        const auto i = std::min(static_cast<std::size_t>(cell), kCells - 2);
        const double t = cell - static_cast<double>(i);
        return (1.0 - t) * _values[i] + t * _values[i + 1];
    }

private:
    static constexpr std::size_t kCells = 4000;
    std::vector<double> _values = std::vector<double>(kCells);
};

struct Tube {
    const char* name;
    int sides;
    double jitter, above, below;
};

class Smoothed : public testing::TestWithParam<Tube> {
protected:
    double worst(double widest) const {
        const Tube& t = GetParam();
        const WeldedMesh mesh(tube(t.sides, t.jitter));
        std::vector<double> field(mesh.vertexCount()), widths(mesh.vertexCount());
        double lastAbove = 0.0, firstBelow = kLength; // the boundary is between them
        for (std::size_t v = 0; v < field.size(); ++v) {
            const double y = mesh.positions[v].y;
            const bool isAbove = y < kLength / 2;
            field[v] = isAbove ? 0.0 : 1.0;
            widths[v] = isAbove ? t.above : t.below;
            if (isAbove) lastAbove = std::max(lastAbove, y);
            if (!isAbove) firstBelow = std::min(firstBelow, y);
        }
        SkinSmoother(mesh, widest).smooth(field, widths);
        const Line line(0.5 * (lastAbove + firstBelow), t.above, t.below);
        double worst = 0.0;
        for (std::size_t v = 0; v < field.size(); ++v)
            worst = std::max(worst, std::abs(field[v] - line.at(mesh.positions[v].y)));
        return worst;
    }
};

} // namespace

TEST_P(Smoothed, MatchesHeatFlowAlongALine) {
    EXPECT_LT(worst(0.0), 0.01);
}

TEST_P(Smoothed, IsSimilarOnCoarserSkins) {
    EXPECT_LT(worst(1.0), 0.02);
}

INSTANTIATE_TEST_SUITE_P(SkinSmoother, Smoothed,
                         testing::Values(Tube{"Even", 150, 0.0, 1.0, 1.0},
                                         Tube{"Jittered", 150, 0.3, 1.0, 1.0},
                                         Tube{"TwoWidths", 150, 0.3, 1.0, 0.6},
                                         Tube{"TwiceCoarser", 300, 0.2, 1.0, 1.0}),
                         [](const auto& test) { return test.param.name; });
