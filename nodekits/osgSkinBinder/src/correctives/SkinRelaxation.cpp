// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/SkinRelaxation.h"

#include "regions/HermiteRatio.h"

#include <Eigen/SparseCholesky>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace osgSkin {
namespace {

using Points = std::vector<glm::dvec3>;

/// Implicit Euler steps.
constexpr int kSteps = 2;

/// Skin is smoothed wholly where a bend leaves less than the first share of its area, and not at
/// all from the second one.
constexpr double kCompressed = 0.6, kLoose = 1.0;

/// Limits of cotangents: weights stay positive, and thin triangles do not stick together.
constexpr double kMinCotangent = 0.05, kMaxCotangent = 5.0;

/// Of the squared width: areas below it count as this much.
constexpr double kSmallArea = 1e-9;

Eigen::Array4f fourOf(const glm::dvec3& point, double fourth) {
    return Eigen::Array4d(point.x, point.y, point.z, fourth).cast<float>();
}

glm::dvec3 pointOf(const Eigen::Array4f& four) {
    return {four[0], four[1], four[2]};
}

} // namespace

SkinRelaxation::SkinRelaxation(const ShapedJoint& joint) : _joint(joint) {
    if (!(joint.relaxation > 0.0) || joint.triangles.empty()) return;
    const auto count = static_cast<Eigen::Index>(joint.vertices.size());
    const double width = joint.relaxation * joint.radius;
    const double time = 0.5 * width * width / kSteps;
    Eigen::VectorXd mass = Eigen::VectorXd::Constant(count, kSmallArea * width * width);
    std::vector<Eigen::Triplet<double>> entries; // of M + time L
    for (const std::array<std::uint32_t, 3>& t : joint.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
            const glm::dvec3 toA = joint.vertices[a].from - joint.vertices[c].from;
            const glm::dvec3 toB = joint.vertices[b].from - joint.vertices[c].from;
            const double area =
                std::max(glm::length(glm::cross(toA, toB)), kSmallArea * width * width);
            const double cotangent =
                std::clamp(glm::dot(toA, toB) / area, kMinCotangent, kMaxCotangent);
            const double weight = 0.5 * time * cotangent;
            mass[c] += area / 6.0;
            const int row = static_cast<int>(a), column = static_cast<int>(b);
            entries.emplace_back(row, column, -weight);
            entries.emplace_back(column, row, -weight);
            entries.emplace_back(row, row, weight);
            entries.emplace_back(column, column, weight);
        }
    for (int i = 0; i < count; ++i) entries.emplace_back(i, i, mass[i]);
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) return;
    _isOn = true;
    _lower = Eigen::SparseMatrix<double>(solver.matrixL().nestedExpression()).cast<float>();
    _row = solver.permutationP().indices();
    _mass = (solver.permutationP() * mass).cast<float>();
    _inverse = solver.vectorD().cwiseInverse().cast<float>();
    Points rest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) rest.push_back(vertex.from);
    _areasAtRest = areasOf(rest).cwiseMax(kSmallArea * width * width);
    for (const Eigen::Array4f& each : smooth(rest, Eigen::VectorXd::Zero(count)))
        _smoothedAtRest.push_back(pointOf(each));
}

Points SkinRelaxation::relaxed(Points points, const std::vector<glm::dquat>& turns) const {
    if (!_isOn) return points;
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(_areasAtRest.size());
    if (!_joint.isSoft) areas = areasOf(points).cwiseQuotient(_areasAtRest);
    const Fours smoothed = smooth(points, areas);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        glm::dvec3 target = pointOf(smoothed[i]);
        double share = vertex.fade;
        if (_joint.isSoft)
            target += turns[i] * (vertex.from - _smoothedAtRest[i]);
        else
            share *= 1.0 - hermiteRatio((smoothed[i][3] - kCompressed) / (kLoose - kCompressed));
        points[i] = glm::mix(points[i], target, share);
    }
    return points;
}

Points SkinRelaxation::smoothed(Points field) const {
    if (!_isOn) return field;
    const Fours smooth = this->smooth(field, Eigen::VectorXd::Zero(_areasAtRest.size()));
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = pointOf(smooth[i]);
    return field;
}

SkinRelaxation::Fours SkinRelaxation::smooth(const Points& points,
                                             const Eigen::VectorXd& values) const {
    Fours x(points.size());
    for (Eigen::Index i = 0; i < values.size(); ++i)
        x[std::size_t(_row[i])] = fourOf(points[std::size_t(i)], values[i]);
    const int count = static_cast<int>(x.size());
    const int* first = _lower.outerIndexPtr();
    const int* rows = _lower.innerIndexPtr();
    const float* factors = _lower.valuePtr();
    for (int step = 0; step < kSteps; ++step) {
        for (int i = 0; i < count; ++i) x[std::size_t(i)] *= _mass[i];
        for (int i = 0; i < count; ++i)
            for (int k = first[i]; k < first[i + 1]; ++k)
                x[std::size_t(rows[k])] -= factors[k] * x[std::size_t(i)];
        for (int i = count; i-- > 0;) {
            Eigen::Array4f sum = _inverse[i] * x[std::size_t(i)];
            for (int k = first[i]; k < first[i + 1]; ++k)
                sum -= factors[k] * x[std::size_t(rows[k])];
            x[std::size_t(i)] = sum;
        }
    }
    Fours result(x.size());
    for (Eigen::Index i = 0; i < values.size(); ++i)
        result[std::size_t(i)] = x[std::size_t(_row[i])];
    return result;
}

Eigen::VectorXd SkinRelaxation::areasOf(const Points& points) const {
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points.size()));
    for (const std::array<std::uint32_t, 3>& t : _joint.triangles) {
        const double area =
            glm::length(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
        for (const std::uint32_t corner : t) areas[corner] += area;
    }
    return areas;
}

} // namespace osgSkin
