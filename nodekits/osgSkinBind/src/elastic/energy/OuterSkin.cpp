// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/OuterSkin.h"

#include <algorithm>
#include <limits>

namespace osgSkin::elastic {
namespace {

double smooth(double from, double to, double at) {
    const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// From the nearest point of the bones.
Point offBones(const std::vector<Bone>& bones, const Point& p) {
    Point nearest = Point::Constant(std::numeric_limits<double>::infinity());
    for (const Bone& bone : bones) {
        const Point off = p - nearestOn(bone, p);
        if (!(off.squaredNorm() >= nearest.squaredNorm())) nearest = off;
    }
    return nearest;
}

} // namespace

OuterSkin::OuterSkin(const SkinPatch& patch, const Points& skin, const std::vector<Bone>& bones,
                     const HingeCore* hinge, const OuterSizes& sizes)
    : _patch(patch), _sizes(sizes), _bones(bones) {
    if (!hinge || !(hinge->outwards.norm() > 0.0) || bones.empty()) return;
    std::vector<double> areas(patch.vertices().size(), 0.0);
    for (const auto& triangle : patch.triangles()) {
        const auto corner = [&](std::size_t i) { return skin.col(patch.vertices()[triangle[i]]); };
        const double area =
            0.5 * Point(corner(1) - corner(0)).cross(Point(corner(2) - corner(0))).norm();
        for (const std::uint32_t v : triangle) areas[v] += area / 3.0;
    }
    for (std::size_t v = 0; v < areas.size(); ++v) {
        const Point p = skin.col(patch.vertices()[v]);
        const double along = hinge->along.dot(p);
        const Point across = p - along * hinge->along;
        const double share =
            smooth(sizes.from, sizes.whole, hinge->outwards.dot(across.normalized())) *
            (1.0 - smooth(sizes.reach, sizes.end, std::abs(along)));
        const double distance = offBones(bones, p).norm();
        if (share * areas[v] * distance > 0.0)
            _held.push_back({v, distance, sizes.stiffness * share * areas[v]});
    }
}

std::vector<Bone> OuterSkin::posed(const Eigen::Quaterniond& turn) const {
    std::vector<Bone> bones = _bones;
    for (Bone& bone : bones)
        if (bone.moves) bone = {turn * bone.from, turn * bone.to, true};
    return bones;
}

double OuterSkin::value(const Points& nodes, const std::vector<Bone>& posed,
                        Points& gradient) const {
    if (_held.empty()) return 0.0;
    const Points skin = _patch.positions(nodes);
    Points pull = Points::Zero(3, skin.cols());
    double energy = 0.0;
    for (const Held& held : _held) {
        const auto column = static_cast<Eigen::Index>(held.vertex);
        const Point off = offBones(posed, skin.col(column));
        const double distance = off.norm();
        const double tooFar = distance - std::clamp(distance, _sizes.least * held.distance,
                                                    _sizes.most * held.distance);
        if (tooFar == 0.0 || !(distance > 0.0)) continue;
        energy += 0.5 * held.stiffness * tooFar * tooFar;
        pull.col(column) = held.stiffness * tooFar / distance * off;
    }
    _patch.spread(pull, gradient);
    return energy;
}

} // namespace osgSkin::elastic
