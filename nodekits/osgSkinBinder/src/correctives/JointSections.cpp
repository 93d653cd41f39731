// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/JointSections.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgSkin {
namespace {

/// Distances along a bone, in radii, between which the depth of flesh is measured.
constexpr double kDepthFrom = 1.0, kDepthTo = 2.5;

/// How far the child's share of the depth may exceed one half.
constexpr double kMaxUneven = 0.08;

/// Sections are widened until they have this share of their area at rest.
constexpr double kAreaKept = 0.97;

/// One bone with the skin of its side of the joint.
struct Bone {
    glm::dvec3 along;    ///< unit, away from the joint
    glm::dvec3 boundary; ///< direction, across `along`, towards the plane in which both sides meet
    double slope;        ///< distance of that plane from the bone, per unit along the bone
};

/// \param share of the angle between both bones that belongs to this one's side
Bone boneAt(const glm::dvec3& along, const glm::dvec3& other, double share) {
    const glm::dvec3 across = other - glm::dot(along, other) * along;
    const double sine = glm::length(across);
    // A straight limb has no fold. Its sections are closed curves, so any origin will do.
    if (sine < 0.1) return {along, glm::dvec3(0.0), 0.0};
    const double angle = std::atan2(sine, glm::dot(along, other));
    return {along, across / sine, std::tan(share * angle)};
}

/// Adds a triangle's part of each section's area: half the cross product of the edge in which the
/// triangle meets the section. Sections near the joint are open in the plane in which both sides
/// meet; the origin lies in that plane, so that the missing edge would add nothing.
/// \param z distance of each corner along the bone
void addTriangle(const std::array<const glm::dvec3*, 3>& corners, const std::array<double, 3>& z,
                 const Bone& bone, double step, JointSections::Values& areas) {
    const double from = std::ceil(std::max(std::min({z[0], z[1], z[2]}), 0.0) / step);
    const double most = std::max({z[0], z[1], z[2]});
    if (!(from <= JointSections::kCount)) return;
    for (auto k = std::max<std::size_t>(1, static_cast<std::size_t>(from));
         k <= JointSections::kCount && double(k) * step <= most; ++k) {
        const double at = double(k) * step;
        const glm::dvec3 origin = at * (bone.along + bone.slope * bone.boundary);
        glm::dvec3 enter(0.0), leave(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if ((z[i] < at) == (z[j] < at)) continue;
            const glm::dvec3 x =
                *corners[i] + (at - z[i]) / (z[j] - z[i]) * (*corners[j] - *corners[i]) - origin;
            (z[i] < at ? enter : leave) = x;
        }
        areas[k - 1] += 0.5 * glm::dot(bone.along, glm::cross(leave, enter));
    }
}

JointSections::Sides areasAcross(const ShapedJoint& joint, const std::vector<bool>& isChilds,
                                 const Bone& parent, const Bone& child,
                                 const std::vector<glm::dvec3>& points) {
    const auto along = [&points](const Bone& bone) {
        std::vector<double> z;
        z.reserve(points.size());
        for (const glm::dvec3& point : points) z.push_back(glm::dot(point, bone.along));
        return z;
    };
    const std::vector<double> alongParent = along(parent), alongChild = along(child);
    JointSections::Sides areas;
    for (std::size_t t = 0; t < joint.triangles.size(); ++t) {
        const auto& [a, b, c] = joint.triangles[t];
        const std::vector<double>& z = isChilds[t] ? alongChild : alongParent;
        addTriangle({&points[a], &points[b], &points[c]}, {z[a], z[b], z[c]},
                    isChilds[t] ? child : parent, JointSections::kStep * joint.radius,
                    isChilds[t] ? areas.child : areas.parent);
    }
    return areas;
}

/// The depth of the flesh on the inner side beside the joint (90th percentile); 0 if not known.
double depthOf(const ShapedJoint& joint, const glm::dvec3& along) {
    if (!(glm::length(joint.hinge) > 0.0)) return 0.0;
    const glm::dvec3 inwards =
        glm::normalize(glm::cross(joint.hinge, glm::dot(along, joint.bone) > 0.0 ? along : -along));
    std::vector<double> depths;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        const double z = glm::dot(along, vertex.from) / joint.radius;
        if (z > kDepthFrom && z < kDepthTo && vertex.limb > 0.5)
            depths.push_back(glm::dot(inwards, vertex.from));
    }
    if (depths.size() < 8) return 0.0;
    const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 9 / 10);
    std::nth_element(depths.begin(), at, depths.end());
    return std::max(*at, 0.0);
}

} // namespace

JointSections::JointSections(const ShapedJoint& joint) : _joint(joint) {
    const double child = depthOf(joint, joint.bone), parent = depthOf(joint, -joint.above);
    if (child > 0.0 && parent > 0.0)
        _childDepth = std::clamp(child / (child + parent), 0.5, 0.5 + kMaxUneven);
    std::vector<glm::dvec3> points;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) points.push_back(vertex.from);
    const glm::dvec3 normal = joint.above + joint.bone;
    for (const auto& t : joint.triangles)
        _isChilds.push_back(glm::dot(points[t[0]] + points[t[1]] + points[t[2]], normal) > 0.0);
    _atRest = areasAcross(joint, _isChilds, boneAt(-joint.above, joint.bone, 1.0 - _childDepth),
                          boneAt(joint.bone, -joint.above, _childDepth), points);
}

JointSections::Sides JointSections::areasOf(const glm::dvec3& above, const glm::dvec3& bone,
                                            const std::vector<glm::dvec3>& posed) const {
    return areasAcross(_joint, _isChilds, boneAt(-above, bone, 1.0 - _childDepth),
                       boneAt(bone, -above, _childDepth), posed);
}

double JointSections::valueAt(const Values& values, double radii) {
    // Quadratic B-splines: continuous slopes.
    const double t = radii / kStep - 1.0;
    const auto middle = static_cast<std::ptrdiff_t>(std::floor(std::clamp(t, -2.0, 100.0) + 0.5));
    const double f = std::clamp(t, -2.0, 100.0) - double(middle);
    const auto at = [&](std::ptrdiff_t i) {
        if (i >= static_cast<std::ptrdiff_t>(kCount)) return 0.0;
        return values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(i, 0))];
    };
    return 0.5 * (0.5 - f) * (0.5 - f) * at(middle - 1) + (0.75 - f * f) * at(middle) +
           0.5 * (0.5 + f) * (0.5 + f) * at(middle + 1);
}

WidthSearch::WidthSearch(const JointSections::Values& atRest, const JointSections::Values& areas)
    : _areas(areas) {
    for (std::size_t k = 0; k < atRest.size(); ++k) {
        _missing[k] = kAreaKept * atRest[k] - areas[k];
        _found[k] = !(_missing[k] > 0.0);
    }
}

void WidthSearch::add(double share, const JointSections::Values& areas) {
    for (std::size_t k = 0; k < areas.size(); ++k) {
        if (_found[k]) continue;
        const double gained = areas[k] - _areas[k];
        const double part = gained > 0.0 ? std::min(1.0, _missing[k] / gained) : 1.0;
        shares[k] = glm::mix(_last, share, part);
        _found[k] = part < 1.0;
        _missing[k] -= gained;
        _areas[k] = areas[k];
    }
    _last = share;
}

} // namespace osgSkin
