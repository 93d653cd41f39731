// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes that move no vertex much faster than the joint rotates.
#include "correctives/LimitVelocity.h"
#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

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

TEST(LimitVelocity, SlowsVerticesNearTheAxis) {
    const ShapedJoint joint = jointWith({0.2, 0.6, 3.0});
    FittedShapes shapes = lifted(joint, 0.25);
    ASSERT_GT(fastest(joint, shapes, 0), 2.0); // otherwise there is nothing to limit
    limitVelocity(joint, shapes);
    EXPECT_LT(fastest(joint, shapes, 0), 1.53);
    EXPECT_GT(fastest(joint, shapes, 0), 1.4); // no more than necessary
    EXPECT_LT(fastest(joint, shapes, 1), 1.53);
}

TEST(LimitVelocity, BlendsIntoNeighbours) {
    const ShapedJoint joint = jointWith({0.2, 0.6, 3.0});
    FittedShapes shapes = lifted(joint, 0.25);
    limitVelocity(joint, shapes);
    EXPECT_GT(shapes.vectors[0].z, 0.0);
    const double left = 1.0 - glm::distance(shapes.vectors[0], glm::dvec3(0, 0, 1));
    EXPECT_NEAR(shapes.vectors[1].z, left + 0.4 / 0.7, 1e-9);
    EXPECT_EQ(shapes.vectors[2], glm::dvec3(0, 0, 1));
}

// A shape that appears only in a part of the bend is slowed down, not removed.
TEST(LimitVelocity, SlowsSuddenShapes) {
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

TEST(LimitVelocity, LeavesSlowShapesUnchanged) {
    const ShapedJoint joint = jointWith({1.0, 2.0});
    FittedShapes shapes = lifted(joint, 0.1);
    limitVelocity(joint, shapes);
    for (const glm::dvec3& vector : shapes.vectors) EXPECT_EQ(vector, glm::dvec3(0, 0, 1));
    FittedShapes none;
    limitVelocity(joint, none);
    EXPECT_TRUE(none.vectors.empty());
}
