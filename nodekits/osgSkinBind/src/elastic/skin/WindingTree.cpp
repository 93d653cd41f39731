// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/skin/WindingTree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace osgSkin::elastic {
namespace {

constexpr std::uint32_t kLeaf = 8;

/// How many times a node's reach a point must be away for the dipole to do: 1 % of a winding.
constexpr double kFarFromSkin = 2.3;

constexpr double kSphere = 12.566370614359172;

/// Adds half a triangle's signed solid angle (van Oosterom & Strackee 1983).
void addSolidAngle(const Point& a, const Point& b, const Point& c, AngleSum& halves) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    halves.add(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

} // namespace

WindingTree::WindingTree(const Points& positions,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    for (const auto& t : triangles)
        _corners.push_back({positions.col(t[0]), positions.col(t[1]), positions.col(t[2])});
    _nodes.emplace_back();
    _nodes[0].end = static_cast<std::uint32_t>(_corners.size());
    if (!_corners.empty()) split(0);
}

void WindingTree::split(std::uint32_t index) {
    measure(_nodes[index]);
    const std::uint32_t begin = _nodes[index].begin, end = _nodes[index].end;
    if (end - begin <= kLeaf) return;
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = begin; i < end; ++i)
        box.extend(_corners[i][0]).extend(_corners[i][1]).extend(_corners[i][2]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto along = [axis](const Corners& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
    std::nth_element(_corners.begin() + begin, _corners.begin() + middle, _corners.begin() + end,
                     [&](const Corners& a, const Corners& b) { return along(a) < along(b); });
    const auto child = static_cast<std::uint32_t>(_nodes.size());
    _nodes.resize(_nodes.size() + 2);
    _nodes[index].child = child;
    _nodes[child].begin = begin;
    _nodes[child].end = _nodes[child + 1].begin = middle;
    _nodes[child + 1].end = end;
    split(child);
    split(child + 1);
}

void WindingTree::measure(Node& node) const {
    node.centre.setZero();
    node.dipole.setZero();
    double area = 0.0;
    Point middle = Point::Zero();
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const auto& [a, b, c] = _corners[i];
        const Point vector = 0.5 * (b - a).cross(c - a);
        node.dipole += vector;
        area += vector.norm();
        node.centre += vector.norm() / 3.0 * (a + b + c);
        middle += (a + b + c) / 3.0;
    }
    node.centre = area > 0.0 ? Point(node.centre / area) : Point(middle / (node.end - node.begin));
    for (std::uint32_t i = node.begin; i < node.end; ++i)
        for (const Point& corner : _corners[i])
            node.reach = std::max(node.reach, (corner - node.centre).norm());
}

double WindingTree::sum(std::uint32_t index, const Point& point, AngleSum& halves) const {
    const Node& node = _nodes[index];
    const Point away = node.centre - point;
    const double distance = away.norm();
    if (distance > kFarFromSkin * node.reach)
        return node.dipole.dot(away) / (distance * distance * distance);
    if (node.child != 0) return sum(node.child, point, halves) + sum(node.child + 1, point, halves);
    for (std::uint32_t i = node.begin; i < node.end; ++i)
        addSolidAngle(_corners[i][0] - point, _corners[i][1] - point, _corners[i][2] - point,
                      halves);
    return 0.0;
}

double WindingTree::at(const Point& point) const {
    if (_corners.empty()) return 0.0;
    AngleSum halves;
    const double far = sum(0, point, halves);
    return (far + 2.0 * halves.value()) / kSphere;
}

bool WindingTree::inside(const Point& point) const {
    return std::abs(at(point)) > 0.5;
}

} // namespace osgSkin::elastic
