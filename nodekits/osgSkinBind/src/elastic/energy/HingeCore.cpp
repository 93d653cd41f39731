// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/HingeCore.h"

#include <limits>

namespace osgSkin::elastic {
namespace {

constexpr double kAtCentre = 1e-3;  ///< bones that begin this near to the joint are its own
constexpr double kSkinWithin = 2.0; ///< how far off the skin of the outer side may be

Point outwardsOf(const std::vector<Bone>& bones, const std::vector<Eigen::Quaterniond>& rotations,
                 Point& across) {
    Point flexion = Point::Zero(), along = Point::Zero();
    for (const Eigen::Quaterniond& q : rotations)
        flexion += q.w() < 0.0 ? Point(-q.vec()) : Point(q.vec());
    for (const Bone& bone : bones)
        if (bone.moves && bone.from.norm() < kAtCentre && bone.to.norm() > along.norm())
            along = bone.to;
    Point outwards = along.cross(flexion); // a flexion takes the bone the other way
    if (!(outwards.norm() > 0.0)) return outwards;
    across = outwards.cross(flexion).normalized();
    if (across.dot(along) < 0.0) across = -across;
    return outwards.normalized();
}

} // namespace

HingeCore hingeCore(const Points& skin, const std::vector<Bone>& bones,
                    const std::vector<Eigen::Quaterniond>& rotations, const HingeSizes& sizes) {
    HingeCore core{Point::Zero(), sizes.radius, Point::Zero(), sizes.halfWidth, Point::Zero()};
    const Point outwards = core.outwards = outwardsOf(bones, rotations, core.along);
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index v = 0; v < skin.cols(); ++v) {
        const double height = outwards.dot(skin.col(v));
        const double beside = (skin.col(v) - height * outwards).norm();
        if (height <= 0.0 || skin.col(v).norm() > kSkinWithin || beside >= nearest) continue;
        nearest = beside;
        core.centre = (height - sizes.below - sizes.radius) * outwards;
    }
    return core;
}

} // namespace osgSkin::elastic
