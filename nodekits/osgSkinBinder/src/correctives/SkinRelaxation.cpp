// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/SkinRelaxation.h"

#include "regions/HermiteRatio.h"

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

Eigen::MatrixXd columnsOf(const Points& points, Eigen::Index count) {
    Eigen::MatrixXd columns =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(points.size()), count);
    for (Eigen::Index i = 0; i < columns.rows(); ++i)
        for (Eigen::Index axis = 0; axis < 3; ++axis)
            columns(i, axis) = points[static_cast<std::size_t>(i)][static_cast<int>(axis)];
    return columns;
}

glm::dvec3 pointAt(const Eigen::MatrixXd& columns, std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    return {columns(row, 0), columns(row, 1), columns(row, 2)};
}

} // namespace

SkinRelaxation::SkinRelaxation(const ShapedJoint& joint) : _joint(joint) {
    if (!(joint.relaxation > 0.0) || joint.triangles.empty()) return;
    const auto count = static_cast<Eigen::Index>(joint.vertices.size());
    const double width = joint.relaxation * joint.radius;
    const double time = 0.5 * width * width / kSteps;
    _mass = Eigen::VectorXd::Constant(count, kSmallArea * width * width);
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
            _mass[c] += area / 6.0;
            const int row = static_cast<int>(a), column = static_cast<int>(b);
            entries.emplace_back(row, column, -weight);
            entries.emplace_back(column, row, -weight);
            entries.emplace_back(row, row, weight);
            entries.emplace_back(column, column, weight);
        }
    for (int i = 0; i < count; ++i) entries.emplace_back(i, i, _mass[i]);
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    _solver.compute(matrix);
    if (_solver.info() != Eigen::Success) return;
    _isOn = true;
    Points rest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) rest.push_back(vertex.from);
    const Columns smoothed = smooth(columnsOf(rest, 3));
    for (std::size_t i = 0; i < rest.size(); ++i) _smoothedAtRest.push_back(pointAt(smoothed, i));
    _areasAtRest = areasOf(rest).cwiseMax(kSmallArea * width * width);
}

std::vector<glm::dvec3> SkinRelaxation::relaxed(Points points, const BendTwist& bend) const {
    if (!_isOn) return points;
    Columns columns = columnsOf(points, 4);
    if (!_joint.isSoft) columns.col(3) = areasOf(points).cwiseQuotient(_areasAtRest);
    columns = smooth(std::move(columns));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        glm::dvec3 target = pointAt(columns, i);
        double share = vertex.fade;
        if (_joint.isSoft) {
            target += _joint.turnOf(vertex, bend) * (vertex.from - _smoothedAtRest[i]);
        } else {
            const double area = columns(static_cast<Eigen::Index>(i), 3);
            share *= 1.0 - hermiteRatio((area - kCompressed) / (kLoose - kCompressed));
        }
        points[i] = glm::mix(points[i], target, share);
    }
    return points;
}

SkinRelaxation::Columns SkinRelaxation::smooth(Columns columns) const {
    for (int i = 0; i < kSteps; ++i)
        columns = _solver.solve((_mass.asDiagonal() * columns).eval()).eval();
    return columns;
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
