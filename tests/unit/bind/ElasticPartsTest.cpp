// SPDX-License-Identifier: GPL-3.0-or-later
//
// The elastic solver's components, each on its own.
#include "ElasticTube.h"
#include "elastic/CountCrossings.h"
#include "elastic/JointSolid.h"
#include "elastic/Minimise.h"
#include "elastic/Preconditioner.h"
#include "elastic/SolveElastic.h"
#include "elastic/solid/CellEnergy.h"
#include "elastic/solid/Energies.h"
#include "elastic/solid/FoldContact.h"
#include "elastic/solid/RestSkin.h"
#include "elastic/solid/VoxelLattice.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>

using namespace osgSkin;

namespace {

using namespace osgSkin::elastic;

Points pointsOf(const ElasticTube& tube) {
    Points result(3, static_cast<Eigen::Index>(tube.positions.size()));
    for (std::size_t v = 0; v < tube.positions.size(); ++v)
        result.col(static_cast<Eigen::Index>(v)) << tube.positions[v].x, tube.positions[v].y,
            tube.positions[v].z;
    return result;
}

Point randomPoint(std::mt19937& random, double reach) {
    std::uniform_real_distribution<double> entry(-reach, reach);
    return {entry(random), entry(random), entry(random)};
}

} // namespace

TEST(WindingTree, TellsInsideFromOutside) {
    const ElasticTube tube;
    const WindingTree tree(tube.positions, tube.triangles);
    std::mt19937 random(1);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point at = randomPoint(random, 2.0);
        const glm::dvec3 p(at.x(), at.y(), at.z());
        const double radius = std::hypot(p.x, p.z);
        if (radius > 0.98 && radius < 1.02) continue; // the tube's facets
        EXPECT_EQ(tree.inside(p), radius < 1.0) << at.transpose();
        // Accuracy is low far from the boundary, but enough to distinguish it from one half.
        EXPECT_NEAR(std::abs(tree.at(p)), radius < 1.0 ? 1.0 : 0.0, 0.1);
        inside += radius < 1.0;
    }
    EXPECT_GT(inside, 200);
}

TEST(RestSkin, KnowsDistancesAndLeavesOutTrianglesWithoutArea) {
    ElasticTube tube;
    tube.triangles.push_back({0, 1, 1});
    const RestSkin skin(pointsOf(tube), tube.triangles);
    EXPECT_NEAR(skin.signedDistance({0, 0, 0}), -1.0, 0.02);
    EXPECT_NEAR(skin.signedDistance({0, 1, 3}), 2.0, 0.02);
    const RestSkin::Nearest nearest = skin.nearest({0.2, 0.4, 1.5});
    EXPECT_NEAR(nearest.shares.sum(), 1.0, 1e-12);
    EXPECT_LT(nearest.triangle, tube.triangles.size() - 1);
    EXPECT_NEAR(nearest.distance, std::hypot(0.2, 1.5) - 1.0, 0.03);
}

TEST(RestSkin, IsClosedIfItHasNoBorder) {
    const ElasticTube closed, open(1.0, glm::dvec3(0.0), false);
    EXPECT_TRUE(RestSkin(pointsOf(closed), closed.triangles).isClosed());
    EXPECT_FALSE(RestSkin(pointsOf(open), open.triangles).isClosed());
    ElasticTube other = closed;
    std::swap(other.triangles[5][0], other.triangles[5][1]); // faces inwards
    EXPECT_FALSE(RestSkin(pointsOf(other), other.triangles).isClosed());
}

TEST(CountCrossings, CountsPairsThatMeetElsewhereThanAtSharedCorners) {
    Points points(3, 6);
    points << 0, 1, 0, 0.2, 0.3, 0.2, //
        0, 0, 1, 0.2, 0.2, 0.3,       //
        0, 0, 0, -1, 1, 1;
    EXPECT_EQ(countCrossings({{0, 1, 2}, {3, 4, 5}}, points), 1u);
    EXPECT_EQ(countCrossings({{0, 1, 2}, {0, 4, 5}}, points), 0u) << "shares a corner";
    EXPECT_EQ(countCrossings({{0, 1, 2}, {0, 1, 4}}, points), 0u) << "shares an edge";
    points.col(4) << 0.3, 0.3, -1;
    EXPECT_EQ(countCrossings({{0, 1, 2}, {0, 4, 5}}, points), 1u) << "a corner, and elsewhere";
    points.rightCols(3).colwise() += Point(3, 0, 0);
    EXPECT_EQ(countCrossings({{0, 1, 2}, {3, 4, 5}}, points), 0u) << "far apart";
}

TEST(VoxelLattice, FillsTheTubeAndEmbedsItsSkinExactly) {
    const ElasticTube tube;
    const RestSkin skin(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(skin, 1.0 / 3.0, 4.0);
    // Cells that hold a sample inside: the tube's volume and up to one cell around it.
    const double volume = double(lattice.cells().size()) / 27.0;
    EXPECT_GT(volume, 3.14 * 7.4);
    EXPECT_LT(volume, 3.14 * 8.2 * 1.4 * 1.4);
    for (Eigen::Index i = 0; i < lattice.rest().cols(); ++i)
        EXPECT_EQ(lattice.rest().col(i).norm() > 4.0 - 1.0 / 3.0, i >= lattice.freeNodes());
    std::size_t embedded = 0;
    for (Eigen::Index v = 0; v < skin.positions().cols(); ++v) {
        Embedded at;
        if (!lattice.embed(skin.positions().col(v), at)) continue;
        ++embedded;
        EXPECT_LT((lattice.positionOf(at, lattice.rest()) - skin.positions().col(v)).norm(), 1e-9);
    }
    EXPECT_GT(embedded, 400u);
}

TEST(VoxelLattice, KnowsMostSidesWithoutAskingTheSkin) {
    const ElasticTube tube;
    const RestSkin skin(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(skin, 1.0 / 3.0, 4.0);
    std::mt19937 random(2);
    int known = 0, all = 0;
    for (int i = 0; i < 4000; ++i) {
        const Point p = randomPoint(random, 2.0);
        ++all;
        const std::optional<bool> inside = lattice.isInside(p);
        if (!inside) {
            EXPECT_LT(skin.distance(p), 0.2) << p.transpose();
            continue;
        }
        ++known;
        EXPECT_EQ(*inside, skin.inside(p)) << p.transpose();
    }
    EXPECT_GT(known, all / 2);
    EXPECT_FALSE(lattice.isInside({0, 7, 0})) << "beyond the ball nothing is known";
}

TEST(FoldSkin, TellsSidesByTheNearestTriangle) {
    // Open below, with a hood over its upper end: two shells.
    ElasticTube tube(1.0, glm::dvec3(0.0), false);
    const ElasticTube hood(1.3, glm::dvec3(0.0, 4.0, 0.0));
    const auto count = static_cast<std::uint32_t>(tube.positions.size());
    for (const auto& [a, b, c] : hood.triangles)
        tube.triangles.push_back({c + count, b + count, a + count}); // winds the other way
    tube.positions.insert(tube.positions.end(), hood.positions.begin(), hood.positions.end());
    const RestSkin skin(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(skin, 1.0 / 3.0, 4.0);
    const SkinPatch patch(lattice, skin, std::vector<double>(tube.positions.size(), 0.5));
    const Eigen::VectorXd ratios = Eigen::VectorXd::Constant(lattice.rest().cols(), 0.5);
    const FoldSkin fold(lattice, skin, patch, ratios, ContactSizes());
    std::mt19937 random(4);
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        const Point p = randomPoint(random, 1.8);
        const RestSkin::Nearest nearest = skin.nearest(p);
        const auto& [a, b, c] = tube.triangles[nearest.triangle];
        const Points& at = skin.positions();
        const Point there = nearest.shares[0] * at.col(a) + nearest.shares[1] * at.col(b) +
                            nearest.shares[2] * at.col(c);
        EXPECT_EQ(fold.isInside(p, nearest, there), skin.inside(p)) << p.transpose();
        inside += skin.inside(p) ? 1 : 0;
    }
    EXPECT_GT(inside, 400);
    EXPECT_LT(inside, 3000);
}

TEST(DeformedCells, LookOnlyWhereItMatters) {
    const ElasticTube tube;
    const RestSkin skin(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(skin, 1.0 / 3.0, 4.0);
    const Points moved = lattice.rest().colwise() + Point(10.0, 0.0, 0.0);
    const DeformedCells cells(lattice, moved);
    const Point place(0.2, 0.3, 0.1);
    EXPECT_EQ(cells.binOf(place), DeformedCells::kNoBin) << "nothing is left there";
    const Point now = place + Point(10.0, 0.0, 0.0);
    ASSERT_LT(cells.binOf(now), cells.bins());
    const auto foundBy = [&](bool matters) {
        int found = 0;
        cells.find(
            cells.binOf(now), now, [&](std::uint32_t) { return matters; },
            [&](std::uint32_t cell, const Point& local) {
                ++found;
                const Point at = lattice.cells()[cell].low + lattice.shape().edge * local;
                EXPECT_LT((at - place).norm(), 1e-6);
                return false;
            });
        return found;
    };
    EXPECT_EQ(foundBy(true), 1);
    EXPECT_EQ(foundBy(false), 0);
}

TEST(Preconditioner, SolvesItsSystem) {
    const ElasticTube tube;
    const RestSkin skin(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(skin, 1.0 / 3.0, 4.0);
    const BoneCores cores(lattice, skin,
                          {{{0, -6, 0}, {0, 0, 0}, false}, {{0, 0, 0}, {0, 6, 0}, true}}, nullptr,
                          CoreSizes());
    ASSERT_GT(cores.held().size(), 10u);
    const Preconditioner preconditioner(lattice, cores);
    std::mt19937 random(5);
    Points way = Points::Zero(3, lattice.rest().cols());
    for (Eigen::Index i = 0; i < lattice.freeNodes(); ++i) way.col(i) = randomPoint(random, 1.0);
    // Gradient of the quadratic energy that it is derived from: 2 |grad u|^2 / 2 and the bones.
    Points gradient = Points::Zero(3, way.cols());
    const auto laplacian = lattice.shape().laplacian();
    for (const VoxelLattice::Cell& cell : lattice.cells())
        for (Eigen::Index a = 0; a < 8; ++a)
            for (Eigen::Index b = 0; b < 8; ++b)
                gradient.col(cell.nodes[std::size_t(a)]) +=
                    2.0 * laplacian(a, b) * way.col(cell.nodes[std::size_t(b)]);
    Points atRest = Points::Zero(3, way.cols()), moved = atRest;
    const Points goals = cores.goals(Eigen::Quaterniond::Identity());
    cores.value(lattice.rest(), goals, atRest);
    cores.value(lattice.rest() + way, goals, moved);
    EXPECT_LT(atRest.cwiseAbs().maxCoeff(), 1e-9);
    const Points found = preconditioner.solve((gradient + moved).cast<float>()).cast<double>();
    EXPECT_LT((found - way).leftCols(lattice.freeNodes()).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_EQ(found.rightCols(found.cols() - lattice.freeNodes()).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Fascia, PullsEachNodeTowardsItsGoalByItsVolume) {
    const ElasticTube tube;
    const RestSkin rest(pointsOf(tube), tube.triangles);
    const VoxelLattice lattice(rest, 1.0 / 3.0, 4.0);
    const Fascia fascia(lattice, 3.0);
    const Points goals = lattice.rest().colwise() + Point(0.1, -0.2, 0.05);
    Points gradient = Points::Zero(3, goals.cols());
    const double energy = fascia.value(lattice.rest(), goals, gradient);
    const double volume = double(lattice.cells().size()) / 27.0;
    EXPECT_NEAR(energy, 0.5 * 3.0 * volume * (0.01 + 0.04 + 0.0025), 1e-9);
    EXPECT_LT((gradient.rowwise().sum() + 3.0 * volume * Point(0.1, -0.2, 0.05)).norm(), 1e-9);
    EXPECT_EQ(fascia.value(goals, goals, gradient), 0.0);
}

/// The constraint on a tube's outer side, where z is negative.
class OuterSkinTest : public ::testing::Test {
protected:
    OuterSkinTest() { core.outwards = -Point::UnitZ(), core.along = Point::UnitY(); }

    /// Energy of the tube widened by a factor, straight or bent.
    double widened(double factor, const HingeCore* hinge, double angle = 0.0) const {
        const OuterSkin outer(patch, points, bones, hinge, OuterSizes());
        Points nodes = lattice.rest();
        nodes.row(0) *= factor;
        nodes.row(2) *= factor;
        const Points skin = patch.positions(nodes);
        Points gradient = Points::Zero(3, skin.cols());
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Point::UnitX()));
        return outer.value(skin, outer.posed(turn), gradient);
    }

    ElasticTube tube;
    Points points = pointsOf(tube);
    RestSkin rest{points, tube.triangles};
    VoxelLattice lattice{rest, 1.0 / 3.0, 4.0};
    SkinPatch patch{lattice, rest, std::vector<double>(tube.positions.size(), 0.5)};
    std::vector<Bone> bones{{{0, -6, 0}, {0, 0, 0}, false}, {{0, 0, 0}, {0, 6, 0}, true}};
    HingeCore core;
};

TEST_F(OuterSkinTest, IsFreeAtRestAndHeldWhereItSwellsOrCavesIn) {
    EXPECT_EQ(widened(1.0, &core), 0.0);
    EXPECT_GT(widened(1.1, &core), 0.1);
    EXPECT_GT(widened(0.9, &core), 0.1);
    EXPECT_EQ(widened(1.1, nullptr), 0.0);
    EXPECT_EQ(widened(1.1, std::make_unique<HingeCore>().get()), 0.0); // its position is undefined
    EXPECT_GT(widened(1.0, &core, 0.5), 0.01); // the bone rotated into it, or away
}

TEST_F(OuterSkinTest, PullsAsItsEnergyGrowsAndOnTheOuterSideAlone) {
    const OuterSkin outer(patch, points, bones, &core, OuterSizes());
    std::mt19937 random(7);
    const Points rested = patch.positions(lattice.rest()), skin = 1.08 * rested;
    Points way = skin;
    for (Eigen::Index i = 0; i < way.cols(); ++i) way.col(i) = randomPoint(random, 1.0);
    const auto turned = outer.posed(Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Point::UnitX())));
    Points gradient = Points::Zero(3, skin.cols()), unused = gradient;
    outer.value(skin, turned, gradient);
    const double step = 1e-5;
    const double growth = (outer.value(skin + step * way, turned, unused) -
                           outer.value(skin - step * way, turned, unused)) /
                          (2.0 * step);
    EXPECT_NEAR(gradient.cwiseProduct(way).sum(), growth, 1e-4 * std::abs(growth));
    EXPECT_GT(std::abs(growth), 0.1);
    for (Eigen::Index i = 0; i < skin.cols(); ++i) {
        const Point at = rested.col(i);
        if (at.z() < 0.7 && std::abs(at.y()) < 2.5) continue;
        EXPECT_EQ(gradient.col(i).norm(), 0.0) << at.transpose();
    }
}

TEST(Minimise, FindsTheMinimumOfACurvedValley) {
    // Rosenbrock's function, (1 - x)^2 + 100 (y - x^2)^2: minimum at (1, 1).
    Energy energy;
    energy.value = [](const Points& at, Points& gradient) {
        const double x = at(0, 0), y = at(1, 0), off = y - x * x;
        gradient.setZero(3, 1);
        gradient(0, 0) = -2.0 * (1.0 - x) - 400.0 * x * off;
        gradient(1, 0) = 200.0 * off;
        return (1.0 - x) * (1.0 - x) + 100.0 * off * off;
    };
    energy.precondition = [](const Directions& gradient) { return gradient; };
    Points at(3, 1);
    at << -1.2, 1.0, 0.0;
    MinimiseLimits limits;
    limits.mostSteps = 300;
    limits.smallStep = 1e-8;
    EXPECT_LT(minimise(energy, at, limits), limits.mostSteps);
    EXPECT_NEAR(at(0, 0), 1.0, 1e-5);
    EXPECT_NEAR(at(1, 0), 1.0, 1e-5);
    limits.mostSteps = 3;
    at << -1.2, 1.0, 0.0;
    EXPECT_EQ(minimise(energy, at, limits), limits.mostSteps);
}

TEST(Minimise, StaysWhereTheEnergyIsDefined) {
    // x - ln x, which is not defined below 0: minimum at 1.
    Energy energy;
    energy.value = [](const Points& at, Points& gradient) {
        const double x = at(0, 0);
        gradient.setZero(3, 1);
        if (x <= 0.0) return std::numeric_limits<double>::infinity();
        gradient(0, 0) = 1.0 - 1.0 / x;
        return x - std::log(x);
    };
    energy.precondition = [](const Directions& gradient) { return Directions(100.0f * gradient); };
    Points at = Points::Zero(3, 1);
    at(0, 0) = 5.0;
    EXPECT_LT(minimise(energy, at, MinimiseLimits()), MinimiseLimits().mostSteps);
    EXPECT_NEAR(at(0, 0), 1.0, 1e-2);
}

TEST(SampleTree, GoesEveryWayOnceInSmallSteps) {
    std::vector<Eigen::Quaterniond> samples;
    for (const double angle : {1.0, 0.5, -0.5, 1.5})
        samples.emplace_back(Eigen::AngleAxisd(angle, Point::UnitX()));
    const SampleTree tree(samples);
    EXPECT_EQ(tree.startingFrom(SampleTree::kRest), (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(tree.startingFrom(1), std::vector<std::size_t>{0});
    EXPECT_EQ(tree.startingFrom(0), std::vector<std::size_t>{3});
    EXPECT_TRUE(tree.startingFrom(2).empty());
}

TEST(ElasticSamples, OfAHingeReachBothEndsInSmallSteps) {
    HingeRange range;
    range.axis = {1, 0, 0};
    range.restFlexion = glm::radians(40.0);
    range.mostFlexion = glm::radians(139.0);
    const auto samples = hingeSamples(range, {0, 1, 0});
    double most = -10.0, least = 10.0;
    std::set<double> along;
    for (const glm::dquat& q : samples) {
        EXPECT_NEAR(glm::dot(glm::axis(q), glm::dvec3(0, 1, 0)), 0.0, 1e-12); // no twist
        if (std::abs(q.z) > 1e-9) continue;                                   // sideways
        const double angle = 2.0 * std::asin(q.x);
        along.insert(angle);
        most = std::max(most, angle);
        least = std::min(least, angle);
    }
    EXPECT_NEAR(most, glm::radians(99.0), 1e-9);
    EXPECT_NEAR(least, glm::radians(-40.0), 1e-9);
    along.insert(0.0);
    for (auto next = std::next(along.begin()); next != along.end(); ++next)
        EXPECT_LT(*next - *std::prev(next), glm::radians(15.1));
    EXPECT_GT(samples.size(), along.size());
}

TEST(ElasticSamples, OfABallJointGoAllAround) {
    const glm::dvec3 pole = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 across = glm::normalize(glm::cross(pole, glm::dvec3(0, 0, 1)));
    const auto samples = ballSamples(pole, across, glm::radians(90.0));
    ASSERT_EQ(samples.size(), 24u);
    EXPECT_EQ(ballSamples(pole, across, glm::radians(150.0)).size(), 40u);
    EXPECT_NEAR(glm::dot(glm::axis(samples.front()), across), 1.0, 1e-12);
    glm::dvec3 sum(0.0);
    double most = 0.0;
    for (const glm::dquat& q : samples) {
        EXPECT_NEAR(glm::dot(glm::axis(q), pole), 0.0, 1e-12);
        sum += glm::axis(q);
        most = std::max(most, glm::angle(q));
    }
    EXPECT_LT(glm::length(sum), 1e-9);
    EXPECT_NEAR(most, glm::radians(90.0), 1e-9);
}

namespace {

using namespace osgSkin::elastic;

constexpr double kEdge = 0.5;
const Flesh kNoBulk{0.0, 0.0, 0.0};

/// A batch with one cell in all lanes, its corners mapped by `map`.
template <typename Map>
CellBatch cellOf(const Map& map) {
    CellBatch batch;
    for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
        const Point p = map(kEdge * Point(double(c & 1u), double(c >> 1 & 1u), double(c >> 2)));
        for (std::size_t i = 0; i < 3; ++i)
            for (float& corner : batch.corner[i][c])
                corner = static_cast<float>(p[static_cast<Eigen::Index>(i)]);
    }
    return batch;
}

double energyOf(const CellShape& shape, const Flesh& flesh, CellBatch batch) {
    EXPECT_TRUE(cellEnergies(shape, flesh, batch));
    for (const float energy : batch.energy) EXPECT_EQ(energy, batch.energy[0]);
    return static_cast<double>(batch.energy[0]);
}

} // namespace

TEST(CellEnergy, IsNothingForACellThatOnlyMoves) {
    const CellShape shape(kEdge);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0, Point(1, 2, -1).normalized()).toRotationMatrix();
    CellBatch batch =
        cellOf([&](const Point& p) { return Point(turn * p + Point(0.3, 0.1, 0.2)); });
    ASSERT_TRUE(cellEnergies(shape, Flesh(), batch));
    for (const float energy : batch.energy) EXPECT_NEAR(energy, 0.0f, 1e-6f);
    for (const auto& along : batch.gradient)
        for (const auto& corner : along)
            for (const float slope : corner) EXPECT_NEAR(slope, 0.0f, 1e-5f);
}

// tr S of F = R S from the quartic's root, compared with singular values.
TEST(CellEnergy, IsTheDistanceToTheNearestRotation) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    const CellShape shape(kEdge);
    int tried = 0;
    while (tried < 200) {
        Eigen::Matrix3d f;
        for (Eigen::Index i = 0; i < 9; ++i) f(i) = entry(random);
        if (f.determinant() < 0.02) continue;
        ++tried;
        const Point s = Eigen::JacobiSVD<Eigen::Matrix3d>(f).singularValues();
        const double expected =
            kEdge * kEdge * kEdge * (s - Point::Ones()).squaredNorm(); // |F - R|^2
        const CellBatch batch = cellOf([&](const Point& p) { return Point(f * p); });
        EXPECT_NEAR(energyOf(shape, kNoBulk, batch), expected, 2e-6) << f;
    }
}

TEST(CellEnergy, GradientIsTheSlopeOfTheValue) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.12, 0.12);
    const CellShape shape(kEdge);
    Flesh flesh;
    flesh.barrierBegins = 1.1; // so that the barrier acts at every point
    CellBatch batch;
    // Each lane has a different cell.
    for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
        const CellBatch one = cellOf([&](const Point& p) {
            return Point(p + Point(shift(random), shift(random), shift(random)));
        });
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t c = 0; c < CellShape::kCorners; ++c)
                batch.corner[i][c][lane] = one.corner[i][c][0];
    }
    ASSERT_TRUE(cellEnergies(shape, flesh, batch));
    constexpr float kStep = 2e-3f;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
            CellBatch up = batch, down = batch;
            for (float& corner : up.corner[i][c]) corner += kStep;
            for (float& corner : down.corner[i][c]) corner -= kStep;
            ASSERT_TRUE(cellEnergies(shape, flesh, up));
            ASSERT_TRUE(cellEnergies(shape, flesh, down));
            for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
                const float slope = (up.energy[lane] - down.energy[lane]) / (2.0f * kStep);
                EXPECT_NEAR(batch.gradient[i][c][lane], slope, 1e-3f * (1.0f + std::abs(slope)));
            }
        }
}

TEST(CellEnergy, IsInfiniteForAnInvertedCell) {
    const CellShape shape(kEdge);
    CellBatch mirrored = cellOf([](const Point& p) { return Point(-p.x(), p.y(), p.z()); });
    EXPECT_FALSE(cellEnergies(shape, Flesh(), mirrored));
    CellBatch flat = cellOf([](const Point& p) { return Point(0.0, p.y(), p.z()); });
    EXPECT_FALSE(cellEnergies(shape, Flesh(), flat));
    // One lane is enough.
    CellBatch batch = cellOf([](const Point& p) { return p; });
    for (std::size_t c = 0; c < CellShape::kCorners; ++c) batch.corner[0][c][5] *= -1.0f;
    EXPECT_FALSE(cellEnergies(shape, Flesh(), batch));
}

TEST(CellEnergy, BarrierGrowsWithoutEndTowardsFlatness) {
    const CellShape shape(kEdge);
    double before = 0.0;
    for (const double thickness : {0.4, 0.1, 0.01, 1e-4, 1e-6}) {
        Flesh flesh{0.0, 10.0, 0.5};
        const CellBatch batch =
            cellOf([&](const Point& p) { return Point(thickness * p.x(), p.y(), p.z()); });
        const double barrier = energyOf(shape, flesh, batch) - energyOf(shape, kNoBulk, batch);
        EXPECT_GT(barrier, before) << thickness;
        before = barrier;
    }
    const double volume = kEdge * kEdge * kEdge;
    EXPECT_NEAR(before, -10.0 * volume * 0.25 * std::log(2e-6), 1e-4); // -(J - J0)^2 ln(J / J0)
}
