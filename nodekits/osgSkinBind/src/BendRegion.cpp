// SPDX-License-Identifier: GPL-3.0-or-later
#include "BendRegion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

/// A bone longer than this many radii is slender: a shoulder's or hip's radius is the trunk's.
constexpr double kSlenderRatio = 2.5;
constexpr double kSlenderRadius = 0.2; ///< of the bone's length

/// How many of the region's vertices show the limb's radius: a tenth, but enough for a median.
constexpr std::size_t kRadiusShare = 10;
constexpr std::size_t kRadiusLeast = 12;

} // namespace

double hermite(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

glm::dvec3 jointPlaneNormal(const PlannedJoint& joint) {
    const glm::dvec3 sum = joint.comingFrom + joint.boneAxis;
    const double length = glm::length(sum);
    return length > 1e-6 ? sum / length : joint.boneAxis; // a bone that folds straight back
}

bool BendRegion::isBelow(std::uint32_t region, std::size_t joint) const {
    for (int j = joints[region].parent; j >= 0; j = joints[static_cast<std::size_t>(j)].parent)
        if (static_cast<std::size_t>(j) == joint) return true;
    return false;
}

std::uint32_t BendRegion::regionAbove(std::size_t joint) const {
    int above = joints[joint].parent;
    while (above > 0 && !joints[static_cast<std::size_t>(above)].holdsRegion)
        above = joints[static_cast<std::size_t>(above)].parent;
    return static_cast<std::uint32_t>(std::max(above, 0));
}

std::vector<double> BendRegion::hardField(std::size_t joint) const {
    const glm::dvec3 normal = jointPlaneNormal(joints[joint]);
    std::vector<double> below(joints.size());
    for (std::uint32_t r = 0; r < joints.size(); ++r) below[r] = isBelow(r, joint) ? 1.0 : 0.0;
    std::vector<double> field(mesh.vertexCount());
    for (std::size_t v = 0; v < field.size(); ++v) {
        field[v] = below[regions[v]];
        if (regions[v] == joint)
            field[v] = glm::dot(mesh.positions[v] - joints[joint].centre, normal) > 0.0 ? 1.0 : 0.0;
    }
    return field;
}

std::vector<double> BendRegion::boundedField(std::size_t joint, double upper, double lower) const {
    const glm::dvec3 normal = jointPlaneNormal(joints[joint]);
    const double length = std::max(joints[joint].boneLength, 1e-9 * mesh.size);
    const std::uint32_t above = regionAbove(joint);
    std::vector<double> field = hardField(joint);
    for (std::size_t v = 0; v < field.size(); ++v) {
        if (regions[v] != joint && regions[v] != above) continue;
        const double along = glm::dot(mesh.positions[v] - joints[joint].centre, normal) / length;
        field[v] = hermite((along - upper) / (lower - upper));
    }
    return field;
}

double BendRegion::limbRadius(std::size_t joint) const {
    const PlannedJoint& bone = joints[joint];
    const glm::dvec3 normal = jointPlaneNormal(bone);
    std::vector<std::pair<double, double>> distances; // to the plane, to the bone's line
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        if (regions[v] != joint) continue;
        const glm::dvec3 d = mesh.positions[v] - bone.centre;
        distances.emplace_back(std::abs(glm::dot(d, normal)),
                               glm::length(d - bone.boneAxis * glm::dot(d, bone.boneAxis)));
    }
    if (distances.empty()) return 0.0;
    const std::size_t count =
        std::min(distances.size(), std::max(kRadiusLeast, distances.size() / kRadiusShare));
    std::sort(distances.begin(), distances.end());
    std::vector<double> radii(count);
    for (std::size_t i = 0; i < count; ++i) radii[i] = distances[i].second;
    std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(count / 2),
                     radii.end());
    const double radius = radii[count / 2];
    const bool slender = bone.boneLength > kSlenderRatio * radius;
    return slender ? std::min(radius, kSlenderRadius * bone.boneLength) : radius;
}

} // namespace osgSkin
