// SPDX-License-Identifier: GPL-3.0-or-later
//
// The reach of shapes around joints: shorter if something else is close.
//
// Shapes that move no vertex much faster than the joint rotates.
#include "correctives/ShapeFit.h"
#include "SharedBody.h"
#include "correctives/LimitVelocity.h"
#include "correctives/ShapedJoint.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <joints/JointPlan.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

namespace {

constexpr double kTolerance = 1e-4;

/// Ten vertices that bulge with the bend, not as a polynomial.
glm::dvec3 offsetAt(std::size_t vertex, const glm::dvec2& xy) {
    const double v = static_cast<double>(vertex);
    return {0.3 * xy.x * xy.x * std::sin(v), 0.2 * std::sin(2.0 * xy.x) * std::cos(v),
            0.1 * xy.y * (1.0 + xy.x)};
}

JointShapes shapesOfHinge() {
    JointShapes shapes;
    shapes.functions.joint = 1;
    shapes.functions.basis = CorrectiveJoint::Basis::Hinge;
    shapes.functions.axis = {1, 0, 0};
    shapes.functions.low = {-0.2, -0.3};
    shapes.functions.high = {0.9, 0.3};
    shapes.functions.knots = {-0.2, 0.0, 0.2, 0.45, 0.7, 0.9};
    for (std::uint32_t v = 0; v < 10; ++v) shapes.vertices.push_back(v);
    for (double x = -0.2; x <= 0.91; x += 0.05)
        for (const double y : {-0.2, 0.0, 0.2}) {
            shapes.samples.emplace_back(x, y);
            shapes.offsets.emplace_back();
            for (std::size_t v = 0; v < 10; ++v)
                shapes.offsets.back().push_back(offsetAt(v, {x, y}));
        }
    return shapes;
}

glm::dvec3 fittedAt(const FittedShapes& fit, std::size_t vertex, const glm::dvec2& xy) {
    double beta[CorrectiveJoint::kMaxModes];
    fit.functions.weights(xy, beta);
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < fit.functions.modes; ++k)
        sum += beta[k] * fit.vectors[vertex * fit.functions.modes + k];
    return sum;
}

} // namespace

TEST(ShapeFit, MeetsItsSamplesAndWhatLiesBetween) {
    const FittedShapes fit = fitShapes(shapesOfHinge(), {6, kTolerance});
    EXPECT_LE(fit.functions.modes, 6u);
    EXPECT_LE(fit.residual, 0.004);
    for (std::size_t v = 0; v < 10; ++v) {
        EXPECT_EQ(glm::length(fittedAt(fit, v, {0.0, 0.0})), 0.0); // at rest nothing moves
        for (const glm::dvec2& xy : {glm::dvec2(0.12, 0.1), {0.33, -0.1}, {0.58, 0.05}, {0.77, 0}})
            EXPECT_LE(glm::distance(fittedAt(fit, v, xy), offsetAt(v, xy)), 0.01) << v;
        for (std::size_t k = 0; k < fit.functions.modes; ++k)
            EXPECT_LE(glm::length(fit.vectors[v * fit.functions.modes + k]), 1.0 + 1e-12);
    }
}

TEST(ShapeFit, MeetsWhatCountsMoreBetter) {
    JointShapes shapes = shapesOfHinge();
    for (std::size_t s = 0; s < shapes.samples.size(); ++s) // a jump, which no smooth sum can fit
        for (glm::dvec3& offset : shapes.offsets[s])
            if (shapes.samples[s].x > 0.62) offset.z += 1.0;
    const auto worst = [](const FittedShapes& fit) {
        double most = 0.0;
        for (double x = 0.0; x < 0.6; x += 0.05)
            most = std::max(most, glm::distance(fittedAt(fit, 3, {x, 0.0}), offsetAt(3, {x, 0.0})));
        return most;
    };
    const double alike = worst(fitShapes(shapes, {6, kTolerance}));
    for (const glm::dvec2& sample : shapes.samples)
        shapes.weights.emplace_back(10, sample.x > 0.62 ? 1e-3 : 1.0);
    EXPECT_GT(alike, 0.1);
    EXPECT_LT(worst(fitShapes(shapes, {6, kTolerance})), 0.3 * alike);
}

TEST(ShapeFit, FewerModesAreWorseAndNoneAreNeededForNothing) {
    JointShapes shapes = shapesOfHinge();
    EXPECT_GT(fitShapes(shapes, {1, kTolerance}).residual,
              2.0 * fitShapes(shapes, {6, kTolerance}).residual);
    for (auto& sample : shapes.offsets)
        for (glm::dvec3& offset : sample) offset = glm::dvec3(0.0);
    EXPECT_EQ(fitShapes(shapes, {6, kTolerance}).functions.modes, 0u);
}

TEST(ShapeFit, HasNoMoreModesThanAreEnough) {
    JointShapes shapes = shapesOfHinge();
    const FittedShapes all = fitShapes(shapes, {6, kTolerance});
    std::vector<double> left; // after one mode, two modes...
    for (std::size_t modes = 1; modes <= all.functions.modes; ++modes)
        left.push_back(fitShapes(shapes, {modes, kTolerance}).residual);
    ASSERT_GE(left.size(), 3u);
    ModeLimits limits{6, kTolerance};
    limits.enough = 1.05 * left[1];
    const FittedShapes some = fitShapes(shapes, limits);
    EXPECT_EQ(some.functions.modes, 2u);
    EXPECT_DOUBLE_EQ(some.residual, left[1]);
    limits.enough = 0.0;
    limits.enoughOfResidual = 1.05 * left[1] / all.residual;
    EXPECT_LE(fitShapes(shapes, limits).functions.modes, 2u);
    EXPECT_GE(fitShapes(shapes, limits).functions.modes, 1u);
}

TEST(ShapeFit, IsPackedForEveryCopyAndLeavesOutWhatHardlyMoves) {
    JointShapes shapes = shapesOfHinge();
    for (auto& sample : shapes.offsets) sample[4] = glm::dvec3(1e-6);
    const FittedShapes fit = fitShapes(shapes, {6, kTolerance});
    const std::vector<std::uint32_t> weldedOf = {0, 4, 7, 7, 12}; // 12 does not belong to the joint
    const Correctives packed = packShapes({fit}, weldedOf);
    const std::vector<std::uint32_t> firstEntry = {0, 1, 1, 2, 3, 3};
    EXPECT_EQ(packed.firstEntry, firstEntry);
    const std::size_t count = packed.sharesOf(0);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(packed.shares[count + i], packed.shares[2 * count + i]); // copies of 7
        EXPECT_NEAR(packed.shares[count + i] / 32767.0,
                    fit.vectors[7 * packed.joints[0].modes + i / 3][static_cast<int>(i % 3)], 2e-5);
    }
}

TEST(ShapeFit, IsPackedWithoutTheLastModesThatMakeNoDifference) {
    const JointShapes shapes = shapesOfHinge();
    FittedShapes fit = fitShapes(shapes, {6, kTolerance});
    fit.tolerance = 0.1; // larger than the effect of bends to the side
    std::vector<std::uint32_t> weldedOf;
    for (std::uint32_t v = 0; v < shapes.vertices.size(); ++v) weldedOf.push_back(v);
    const Correctives packed = packShapes({fit}, weldedOf);
    const std::size_t modes = fit.functions.modes, last = 3 * (modes - 1);
    ASSERT_GE(modes, 3u);
    std::size_t leftOut = 0;
    for (std::uint32_t v = 0; v < weldedOf.size(); ++v) {
        const std::uint32_t entry = packed.firstEntry[v];
        ASSERT_EQ(packed.firstEntry[v + 1], entry + 1);
        const std::int16_t* shares = &packed.shares[packed.entries[entry].firstShare];
        if (std::all_of(shares + last, shares + last + 3, [](auto share) { return share == 0; }))
            ++leftOut;
        FittedShapes now = fit;
        for (std::size_t i = 0; i < 3 * modes; ++i)
            now.vectors[v * modes + i / 3][static_cast<int>(i % 3)] = shares[i] / 32767.0;
        for (const glm::dvec2& xy : shapes.samples)
            EXPECT_LE(glm::distance(fittedAt(now, v, xy), fittedAt(fit, v, xy)), 0.1001) << v;
    }
    EXPECT_EQ(leftOut, weldedOf.size());
}

namespace {

const Armpit pit{{1.5, 2.25}, {0.0, 1.0, 0.0}}; // the trunk is below

/// The farthest vertices that a joint's shapes move while its pit is closed, in radii: those more
/// than 30 degrees from the plane across the limb towards the trunk, and those on the other side.
struct Farthest {
    double pit = 0.0, away = 0.0;
};

Farthest farthestOf(const ShapedJoint& shaped, const glm::dvec3& root) {
    glm::dvec3 away = shaped.centre - root;
    away = glm::normalize(away - shaped.bone * glm::dot(away, shaped.bone));
    Farthest result;
    for (const ShapedJoint::Vertex& vertex : shaped.vertices) {
        EXPECT_GE(vertex.fade, vertex.fadeClosed);
        if (vertex.fadeClosed * vertex.limb <= 0.0) continue;
        const double length = glm::length(vertex.from);
        const double lean = -glm::dot(vertex.from, away) / length;
        double& most = lean > 0.5 ? result.pit : result.away;
        if (lean > 0.5 || lean < 0.0) most = std::max(most, length / shaped.radius);
    }
    return result;
}

} // namespace

TEST(ShapeReach, FallsFromItsWholeToItsEnd) {
    const ShapeReach reach{2.0, 4.0};
    EXPECT_EQ(reach.shareAt(0.0), 1.0);
    EXPECT_EQ(reach.shareAt(2.0), 1.0);
    EXPECT_NEAR(reach.shareAt(3.0), 0.5, 1e-12);
    EXPECT_EQ(reach.shareAt(4.0), 0.0);
    EXPECT_EQ(reach.shareAt(9.0), 0.0);
    for (double r = 2.0; r < 4.0; r += 0.1) EXPECT_GE(reach.shareAt(r), reach.shareAt(r + 0.1));
}

TEST(ShapeReach, IsLessTowardsThePit) {
    const ShapeReach reach{2.0, 4.0};
    const auto endAt = [&](double degrees) { // below the plane across `away`
        const double angle = degrees / 180.0 * std::acos(-1.0);
        return reachTowards({3.0 * std::cos(angle), -3.0 * std::sin(angle), 0.0}, reach, pit).end;
    };
    EXPECT_EQ(endAt(-80.0), 4.0);
    EXPECT_EQ(endAt(0.0), 4.0);
    EXPECT_LT(endAt(15.0), 4.0);
    EXPECT_GT(endAt(15.0), 2.25);
    EXPECT_NEAR(endAt(30.0), 2.25, 1e-9);
    EXPECT_EQ(endAt(90.0), 2.25);
    EXPECT_EQ(reachTowards({0.0, -1.0, 0.0}, reach, pit).whole, 1.5);
}

TEST(ShapeReach, IsTheSameAllAroundWithoutAPit) {
    const ShapeReach reach{2.0, 4.0};
    const Armpit none{{1.5, 2.25}};
    EXPECT_EQ(reachTowards({0.0, -1.0, 0.0}, reach, none).end, 4.0);
    EXPECT_EQ(reachTowards({0.0, 0.0, 0.0}, reach, pit).end, 4.0); // the joint itself
}

TEST(ShapeReach, APitIsOpenWhereTheLimbIsRaised) {
    ShapedJoint joint;
    joint.functions.axis = {0.0, 0.0, 1.0};
    joint.twistAxis = joint.bone = {1.0, 0.0, 0.0}; // sideways
    joint.away = {0.0, 1.0, 0.0};
    const auto closedAt = [&](double degrees) { // raised by these degrees
        return joint.armpitClosure(
            joint.bendAt({std::sin(0.5 * degrees / 180.0 * std::acos(-1.0)), 0.0}));
    };
    EXPECT_EQ(closedAt(60.0), 0.0);
    EXPECT_EQ(closedAt(90.0), 0.0);
    EXPECT_GT(closedAt(0.0), 0.5);
    EXPECT_GT(closedAt(0.0), closedAt(20.0));
    EXPECT_EQ(closedAt(-20.0), 1.0);
    EXPECT_EQ(closedAt(-80.0), 1.0);
}

TEST(ShapeReach, EndsEarlierInArmpitsAndAtHips) {
    const auto obj = shared::makehuman() / "body/body4k_neutral.obj";
    if (!std::filesystem::exists(obj)) GTEST_SKIP() << obj << " is not here";
    const SkinMesh mesh = shared::readObj(obj);
    const RestSkeleton rig =
        shared::readJoints(shared::makehuman() / "rig/joints_cmu_mb_neutral.json");
    const WeldedMesh skin(mesh);
    std::vector<std::string> notes;
    ShapeScope scope;
    scope.trunkToo = true;
    scope.atTrunk = {2.0, 4.0};
    scope.besideLimb = {2.0, 3.0};
    scope.inPit = {1.5, 2.25};
    std::size_t arms = 0, legs = 0;
    for (const ShapedJoint& shaped :
         findShapedJoints(rig, planJoints(rig, skin, {}, notes), skin, bind(mesh, rig), scope)) {
        const std::string& name = rig.joints[shaped.functions.joint].name;
        const Farthest farthest = farthestOf(shaped, rig.joints[0].centre);
        if (name == "LeftArm" || name == "RightArm") {
            ++arms;
            EXPECT_LT(farthest.pit, 2.25 + 1e-9);
            EXPECT_GT(farthest.pit, 1.8);
            EXPECT_LT(farthest.away, 4.0);
            EXPECT_GT(farthest.away, 3.0);
        }
        if (name == "LeftUpLeg" || name == "RightUpLeg") {
            ++legs;
            EXPECT_LT(std::max(farthest.pit, farthest.away), 3.0);
            EXPECT_GT(std::max(farthest.pit, farthest.away), 2.5);
        }
    }
    EXPECT_EQ(arms, 2u);
    EXPECT_EQ(legs, 2u);
}

namespace {

/// A hinge about x of a limb along y, and skin that follows it fully, at these distances from the
/// axis.
ShapedJoint jointWith(const std::vector<double>& radii) {
    ShapedJoint joint;
    joint.functions.joint = 1;
    joint.functions.basis = CorrectiveJoint::Basis::Ball;
    joint.functions.axis = {1, 0, 0};
    joint.functions.low = {-0.7, -0.7};
    joint.functions.high = {0.7, 0.7};
    joint.twistAxis = joint.bone = {0, 1, 0};
    joint.radius = 1.0;
    for (std::uint32_t v = 0; v < radii.size(); ++v)
        joint.vertices.push_back({v, {0.0, 0.0, radii[v]}, 1.0, 1.0, 1.0, 1.0, 1.0});
    return joint;
}

/// Lifts all vertices off the axis as the joint bends, by `most` at a right angle.
FittedShapes lifted(const ShapedJoint& joint, double most) {
    FittedShapes shapes;
    shapes.functions = joint.functions;
    shapes.functions.modes = 1;
    shapes.functions.coefficients.assign(shapes.functions.functionCount(), 0.0);
    shapes.functions.coefficients[0] = most / 0.7; // of x
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        shapes.vertices.push_back(vertex.index);
        shapes.vectors.emplace_back(0.0, 0.0, 1.0);
    }
    return shapes;
}

/// The largest step per degree about the joint's main axis, relative to a rigid body's.
double fastest(const ShapedJoint& joint, const FittedShapes& shapes, std::size_t vertex) {
    const ShapedJoint::Vertex& of = joint.vertices[vertex];
    const auto at = [&](double degrees) {
        const glm::dvec2 xy(std::sin(glm::radians(0.5 * degrees)), 0.0);
        double weights[CorrectiveJoint::kMaxModes];
        shapes.functions.weights(xy, weights);
        const std::size_t modes = shapes.functions.modes;
        glm::dvec3 moved = of.from;
        for (std::size_t k = 0; k < modes; ++k)
            moved += weights[k] * shapes.vectors[vertex * modes + k];
        return joint.turnOf(of, joint.bendAt(xy)) * moved;
    };
    double most = 0.0;
    for (double degrees = -179.0; degrees < 179.0; degrees += 1.0)
        most = std::max(most, glm::distance(at(degrees), at(degrees + 1.0)));
    return most / (2.0 * std::sin(glm::radians(0.5)) * of.from.z);
}

} // namespace

TEST(LimitVelocity, HoldBackWhatIsNearTheAxis) {
    const ShapedJoint joint = jointWith({0.2, 0.6, 3.0});
    FittedShapes shapes = lifted(joint, 0.25);
    ASSERT_GT(fastest(joint, shapes, 0), 2.0); // otherwise there is nothing to limit
    limitVelocity(joint, shapes);
    EXPECT_LT(fastest(joint, shapes, 0), 1.53);
    EXPECT_GT(fastest(joint, shapes, 0), 1.4); // no more than necessary
    EXPECT_LT(fastest(joint, shapes, 1), 1.53);
}

TEST(LimitVelocity, TakeNeighboursAlongAndLeaveOthersAlone) {
    const ShapedJoint joint = jointWith({0.2, 0.6, 3.0});
    FittedShapes shapes = lifted(joint, 0.25);
    limitVelocity(joint, shapes);
    EXPECT_GT(shapes.vectors[0].z, 0.0);
    const double left = 1.0 - glm::distance(shapes.vectors[0], glm::dvec3(0, 0, 1));
    EXPECT_NEAR(shapes.vectors[1].z, left + 0.4 / 0.7, 1e-9);
    EXPECT_EQ(shapes.vectors[2], glm::dvec3(0, 0, 1));
}

// A shape that appears only in a part of the bend is slowed down, not removed.
TEST(LimitVelocity, SlowDownWhatComesFast) {
    const ShapedJoint joint = jointWith({1.0});
    FittedShapes shapes = lifted(joint, 0.0);
    const std::size_t functions = shapes.functions.functionCount();
    shapes.functions.modes = 3; // x^2, x^3 and x
    shapes.functions.coefficients.assign(3 * functions, 0.0);
    shapes.functions.coefficients[2] = 1.0;
    shapes.functions.coefficients[functions + 5] = 1.0;
    shapes.functions.coefficients[2 * functions] = 1.0;
    const double most = 0.7;
    // From 0 to `most` and back to slope 0 at the end of the range, along the limb: largest
    // halfway.
    shapes.vectors = {{0.0, 3.0 * most / 0.49, 0.0}, {0.0, -2.0 * most / 0.343, 0.0}, {0, 0, 0}};
    const auto offsetAt = [&](double x) {
        double weights[3];
        shapes.functions.weights({x, 0.0}, weights);
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < 3; ++k) sum += weights[k] * shapes.vectors[k];
        return sum;
    };
    const glm::dvec3 before = offsetAt(0.6);
    ASSERT_GT(fastest(joint, shapes, 0), 1.6);
    limitVelocity(joint, shapes);
    EXPECT_LT(fastest(joint, shapes, 0), 1.53);
    EXPECT_GT(offsetAt(0.6).y, 0.9 * before.y);
}

TEST(LimitVelocity, LeaveSlowShapesAsTheyAre) {
    const ShapedJoint joint = jointWith({1.0, 2.0});
    FittedShapes shapes = lifted(joint, 0.1);
    limitVelocity(joint, shapes);
    for (const glm::dvec3& vector : shapes.vectors) EXPECT_EQ(vector, glm::dvec3(0, 0, 1));
    FittedShapes none;
    limitVelocity(joint, none);
    EXPECT_TRUE(none.vectors.empty());
}
