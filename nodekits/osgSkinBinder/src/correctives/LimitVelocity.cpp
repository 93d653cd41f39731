// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/LimitVelocity.h"

#include "correctives/ShapedJoint.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace osgSkin {
namespace {

/// Axes around the joint; how far it bends about each, and between steps, degrees.
constexpr int kAxes = 8, kMaxBend = 176, kBendStep = 4;

/// Coordinates that are clamped by less count as in range.
constexpr double kHardlyClamped = 0.02;

/// Steps of one degree by which a joint may bend: about axes all around it, each over the whole
/// range of bends, sampled or not.
class PoseSweep {
public:
    /// A bend and the modes' weights at it.
    struct Bend {
        BendTwist bend;
        std::array<double, CorrectiveJoint::kMaxModes> weights;
    };

    struct Step {
        Bend from, to;
        glm::dvec3 axis; ///< unit
        bool isInRange;  ///< was sampled: the functions' coordinates are not clamped
    };

    /// \param functions the joint's, with modes and coefficients
    PoseSweep(const ShapedJoint& joint, const CorrectiveJoint& functions) {
        const auto bendAt = [&](const glm::dvec2& xy) {
            Bend result{joint.bendAt(xy), {}};
            functions.weights(xy, result.weights.data());
            return result;
        };
        for (int i = 0; i < kAxes; ++i) {
            const double direction = glm::pi<double>() * i / kAxes;
            const glm::dvec2 way(std::cos(direction), std::sin(direction));
            const glm::dvec3 axis = joint.bendAt(way * 0.5).bendAxis;
            for (int degrees = -kMaxBend; degrees < kMaxBend; degrees += kBendStep) {
                const glm::dvec2 from = std::sin(glm::radians(0.5 * degrees)) * way,
                                 to = std::sin(glm::radians(0.5 * (degrees + 1))) * way;
                _steps.push_back({bendAt(from), bendAt(to), axis,
                                  glm::distance(functions.clamped(to), to) < kHardlyClamped});
            }
        }
    }

    const std::vector<Step>& all() const { return _steps; }

    /// How far a step moves a rigid body's points, for each unit of their distance from the axis.
    static double rigid() { return 2.0 * std::sin(glm::radians(0.5)); }

private:
    std::vector<Step> _steps;
};

/// Changes the vectors of a vertex' modes as little as possible so that no step moves it too far.
///
/// The change is measured in the shapes at the sampled bends. So a fast movement is slowed down
/// where it occurs, and the shapes before and after it stay nearly the same; scaling all shapes
/// would weaken the deepest ones, too.
class HeldVectors {
public:
    /// \param steps must outlive this object
    /// \param modes at least 1
    HeldVectors(const ShapedJoint& joint, const PoseSweep& steps, std::size_t modes);

    /// \param vectors `modes` of them, changed if steps are too long
    /// \return the share of the shapes that is left, 0 to 1: 1 minus the relative change
    double hold(const ShapedJoint::Vertex& vertex, glm::dvec3* vectors) const;

private:
    double sizeOf(const Eigen::MatrixXd& vectors) const;

    const ShapedJoint& _joint;
    const PoseSweep& _steps;
    std::size_t _modes;
    Eigen::MatrixXd _gram;    ///< of the modes' weights over the sampled bends
    Eigen::MatrixXd _inverse; ///< of `_gram`
};

constexpr double kFastest = 1.5; ///< times a rigid body's step

/// Least distance from the axis that is assumed, in radii of the limb: skin at the axis hardly
/// moves.
constexpr double kAtAxis = 0.1;

/// Regularises the modes' Gram matrix, relative to the weights' mean square.
constexpr double kRegular = 1e-6;

constexpr int kMaxRounds = 100;

/// Relative tolerance of steps' lengths.
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
              const PoseSweep::Step& step) {
    const double radius =
        std::max(glm::length(glm::cross(step.axis, vertex.from)), kAtAxis * joint.radius);
    return kFastest * PoseSweep::rigid() * radius;
}

/// Whether a step is too long: a quick test that most vertices pass.
bool isTooLong(const ShapedJoint& joint, const ShapedJoint::Vertex& vertex,
               const PoseSweep::Step& step, const glm::dvec3* vectors, std::size_t modes) {
    const auto at = [&](const PoseSweep::Bend& bend) {
        glm::dvec3 sum = vertex.from;
        for (std::size_t k = 0; k < modes; ++k) sum += bend.weights[k] * vectors[k];
        return joint.turnOf(vertex, bend.bend) * sum;
    };
    return glm::distance(at(step.from), at(step.to)) > mostOf(joint, vertex, step);
}

/// A step of one vertex: plain + sum over the modes of shares[k] U_k, and its greatest length.
struct VertexStep {
    Eigen::Vector3d plain;
    Eigen::Matrix<double, 3, Eigen::Dynamic> shares; ///< 3 x 3 for each mode, side by side
    double most;

    /// \param vectors 3 for each mode, one below the other
    Eigen::Vector3d with(const Eigen::VectorXd& vectors) const { return plain + shares * vectors; }
};

VertexStep stepOf(const ShapedJoint& joint, const ShapedJoint::Vertex& vertex,
                  const PoseSweep::Step& step, std::size_t modes) {
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

/// The largest factor, 0 to 1, of the vectors with which a step is not too long.
double shareWithin(const VertexStep& step, const Eigen::VectorXd& vectors) {
    const Eigen::Vector3d shape = step.shares * vectors;
    const double square = shape.squaredNorm();
    if (!(square > 0.0)) return 1.0;
    const double along = step.plain.dot(shape);
    const double room = step.most * step.most - step.plain.squaredNorm();
    return std::clamp((std::sqrt(std::max(0.0, along * along + square * room)) - along) / square,
                      0.0, 1.0);
}

/// The least change of vectors that changes a step by `by`.
/// \param inverse of the Gram matrix that measures the change
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

HeldVectors::HeldVectors(const ShapedJoint& joint, const PoseSweep& steps, std::size_t modes)
    : _joint(joint), _steps(steps), _modes(modes) {
    const auto count = Eigen::Index(modes);
    _gram = Eigen::MatrixXd::Zero(count, count);
    for (const PoseSweep::Step& step : steps.all()) {
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
    const std::vector<PoseSweep::Step>& steps = _steps.all();
    if (std::none_of(steps.begin(), steps.end(), [&](const PoseSweep::Step& step) {
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
    for (const PoseSweep::Step& step : steps) all.push_back(stepOf(_joint, vertex, step, _modes));

    // Projections onto one step after the other.
    bool isHeld = false;
    for (int round = 0; round < kMaxRounds && !isHeld; ++round) {
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

/// How far the limit of a vertex affects its neighbours, in radii.
constexpr double kFade = 0.7;

/// Lowers the shares around vertices with less than a whole share, so that shares grow gradually.
std::vector<double> faded(const std::vector<const ShapedJoint::Vertex*>& vertices,
                          const std::vector<double>& shares, double radius) {
    std::vector<double> result = shares;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (shares[v] >= 1.0) continue;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double away = glm::distance(vertices[i]->from, vertices[v]->from);
            result[i] = std::min(result[i], shares[v] + away / (kFade * radius));
        }
    }
    return result;
}

} // namespace

void limitVelocity(const ShapedJoint& joint, FittedShapes& shapes) {
    const std::size_t modes = shapes.functions.modes;
    if (modes == 0) return;
    std::unordered_map<std::uint32_t, const ShapedJoint::Vertex*> known;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) known[vertex.index] = &vertex;
    const PoseSweep steps(joint, shapes.functions);
    const HeldVectors vectors(joint, steps, modes);
    std::vector<const ShapedJoint::Vertex*> vertices;
    std::vector<double> shares; // that are left of their shapes
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        vertices.push_back(known.at(shapes.vertices[v]));
        shares.push_back(vectors.hold(*vertices.back(), &shapes.vectors[v * modes]));
    }
    const std::vector<double> kept = faded(vertices, shares, joint.radius);
    for (std::size_t v = 0; v < shares.size(); ++v) {
        if (kept[v] >= shares[v]) continue;
        for (std::size_t k = 0; k < modes; ++k)
            shapes.vectors[v * modes + k] *= kept[v] / shares[v];
    }
}

} // namespace osgSkin
