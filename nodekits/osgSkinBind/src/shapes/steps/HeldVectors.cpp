// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/steps/HeldVectors.h"

#include <Eigen/LU>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kFastest = 1.5; ///< times a rigid body's step

/// Skin nearer to the axis counts as this far off it, in radii of the limb: it hardly moves.
constexpr double kAtAxis = 0.1;

/// Of the modes' weights' mean square: what makes their Gram matrix regular.
constexpr double kRegular = 1e-6;

constexpr int kMostRounds = 100;

/// Steps that are longer by less than that are held.
constexpr double kSlack = 1e-3;

Eigen::Matrix3d toEigen(const glm::dquat& turn) {
    const glm::dmat3 columns = glm::mat3_cast(turn);
    Eigen::Matrix3d result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) result(row, column) = columns[column][row];
    return result;
}

Eigen::Vector3d toEigen(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

double mostOf(const ShapedJoint& joint, const ShapedJoint::Vertex& vertex,
              const BendSteps::Step& step) {
    const double radius =
        std::max(glm::length(glm::cross(step.axis, vertex.from)), kAtAxis * joint.radius);
    return kFastest * BendSteps::rigid() * radius;
}

/// Whether a step is too long: what most vertices are asked, without all that follows where one is.
bool isTooLong(const ShapedJoint& joint, const ShapedJoint::Vertex& vertex,
               const BendSteps::Step& step, const glm::dvec3* vectors, std::size_t modes) {
    const auto at = [&](const BendSteps::Bend& bend) {
        glm::dvec3 sum = vertex.from;
        for (std::size_t k = 0; k < modes; ++k) sum += bend.weights[k] * vectors[k];
        return joint.turnOf(vertex, bend.bend) * sum;
    };
    return glm::distance(at(step.from), at(step.to)) > mostOf(joint, vertex, step);
}

/// A step of one vertex: plain + sum over the modes of shares[k] U_k, and how long it may be.
struct VertexStep {
    Eigen::Vector3d plain;
    Eigen::Matrix<double, 3, Eigen::Dynamic> shares; ///< 3 x 3 for each mode, side by side
    double most;

    /// \param vectors 3 for each mode, one below the other
    Eigen::Vector3d with(const Eigen::VectorXd& vectors) const { return plain + shares * vectors; }
};

VertexStep stepOf(const ShapedJoint& joint, const ShapedJoint::Vertex& vertex,
                  const BendSteps::Step& step, std::size_t modes) {
    const Eigen::Matrix3d from = toEigen(joint.turnOf(vertex, step.from.bend)),
                          to = toEigen(joint.turnOf(vertex, step.to.bend));
    VertexStep result{(to - from) * toEigen(vertex.from), {}, 0.0};
    result.shares.resize(3, Eigen::Index(3 * modes));
    for (std::size_t k = 0; k < modes; ++k)
        result.shares.middleCols<3>(Eigen::Index(3 * k)) =
            step.to.weights[k] * to - step.from.weights[k] * from;
    result.most = std::max(mostOf(joint, vertex, step), result.plain.norm());
    return result;
}

/// The largest share, 0 to 1, of the vectors with which a step is not too long.
double shareWithin(const VertexStep& step, const Eigen::VectorXd& vectors) {
    const Eigen::Vector3d shape = step.shares * vectors;
    const double square = shape.squaredNorm();
    if (!(square > 0.0)) return 1.0;
    const double along = step.plain.dot(shape);
    const double room = step.most * step.most - step.plain.squaredNorm();
    return std::clamp((std::sqrt(std::max(0.0, along * along + square * room)) - along) / square,
                      0.0, 1.0);
}

/// The least change of vectors that changes a step by so much.
/// \param inverse of the Gram matrix by which it is the least
Eigen::VectorXd changeBy(const VertexStep& step, const Eigen::MatrixXd& inverse,
                         const Eigen::Vector3d& by) {
    const Eigen::Index modes = inverse.rows();
    Eigen::MatrixXd along = Eigen::MatrixXd::Zero(3 * modes, 3);
    for (Eigen::Index k = 0; k < modes; ++k)
        for (Eigen::Index l = 0; l < modes; ++l)
            along.middleRows<3>(3 * k) +=
                inverse(k, l) * step.shares.middleCols<3>(3 * l).transpose();
    return along * Eigen::Matrix3d(step.shares * along).fullPivLu().solve(by);
}

} // namespace

HeldVectors::HeldVectors(const ShapedJoint& joint, const BendSteps& steps, std::size_t modes)
    : _joint(joint), _steps(steps), _modes(modes) {
    const auto count = Eigen::Index(modes);
    _gram = Eigen::MatrixXd::Zero(count, count);
    for (const BendSteps::Step& step : steps.all()) {
        if (!step.isInRange) continue;
        const Eigen::Map<const Eigen::VectorXd> weights(step.to.weights.data(), count);
        _gram += weights * weights.transpose();
    }
    _gram.diagonal().array() += kRegular * std::max(_gram.trace() / double(modes), 1e-300);
    _inverse = _gram.inverse();
}

double HeldVectors::sizeOf(const Eigen::MatrixXd& vectors) const {
    return std::sqrt(std::max(0.0, (vectors * _gram * vectors.transpose()).trace()));
}

double HeldVectors::hold(const ShapedJoint::Vertex& vertex, glm::dvec3* vectors) const {
    const std::vector<BendSteps::Step>& steps = _steps.all();
    if (std::none_of(steps.begin(), steps.end(), [&](const BendSteps::Step& step) {
            return isTooLong(_joint, vertex, step, vectors, _modes);
        }))
        return 1.0;

    const auto modes = Eigen::Index(_modes);
    Eigen::VectorXd held(3 * modes);
    for (std::size_t k = 0; k < _modes; ++k)
        held.segment<3>(Eigen::Index(3 * k)) = toEigen(vectors[k]);
    const Eigen::VectorXd before = held;

    std::vector<VertexStep> all;
    all.reserve(steps.size());
    for (const BendSteps::Step& step : steps) all.push_back(stepOf(_joint, vertex, step, _modes));

    // Projections onto one step after the other.
    bool isHeld = false;
    for (int round = 0; round < kMostRounds && !isHeld; ++round) {
        isHeld = true;
        for (const VertexStep& step : all) {
            const Eigen::Vector3d now = step.with(held);
            if (now.norm() <= step.most * (1.0 + kSlack)) continue;
            isHeld = false;
            held += changeBy(step, _inverse, (step.most / now.norm() - 1.0) * now);
        }
    }
    double share = 1.0;
    for (const VertexStep& step : all) share = std::min(share, shareWithin(step, held));
    held *= share;
    const Eigen::Map<const Eigen::MatrixXd> was(before.data(), 3, modes), is(held.data(), 3, modes);
    for (std::size_t k = 0; k < _modes; ++k)
        for (int axis = 0; axis < 3; ++axis) vectors[k][axis] = held[Eigen::Index(3 * k) + axis];
    const double size = sizeOf(was);
    return size > 0.0 ? std::clamp(1.0 - sizeOf(is - was) / size, 0.0, 1.0) : 1.0;
}

} // namespace osgSkin
