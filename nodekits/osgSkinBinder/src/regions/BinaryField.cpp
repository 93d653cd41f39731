// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/BinaryField.h"

#include "regions/HermiteRatio.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// The least length of a limb, in radii: upper arms have three to four, necks less than two.
constexpr double kLimbLength = 2.2;

double limbRadius(const BinaryField& binary, std::size_t joint) {
    const WeldedMesh& mesh = binary.mesh;
    const PlannedJoint& bone = binary.joints[joint];
    const std::vector<double> field = binary.divided(joint);
    std::vector<double> radii; // one for each edge across the division
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        if (field[v] < 0.5) continue;
        for (const std::uint32_t next : mesh.neighboursOf(v)) {
            if (field[next] >= 0.5) continue;
            const glm::dvec3 d = 0.5 * (mesh.positions[v] + mesh.positions[next]) - bone.centre;
            radii.push_back(glm::length(d - bone.boneAxis * glm::dot(d, bone.boneAxis)));
        }
    }
    if (radii.empty()) return 0.0;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
}

/// Skin is in the middle between two limbs if its distances to them differ by at most this share of
/// their sum.
constexpr double kMiddle = 0.01;

/// The distance of a point to the nearest bone of a limb's joints.
double distanceToLimb(const std::vector<PlannedJoint>& joints, const std::vector<bool>& isOfLimb,
                      const glm::dvec3& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < isOfLimb.size(); ++j)
        if (isOfLimb[j] && joints[j].holdsRegion())
            nearest = std::min(nearest, distanceToBone(joints[j], point));
    return nearest;
}

bool leavesTrunk(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    return joint > 0 && joints[joint].holdsRegion() && !joints[joint].isOfTrunk() &&
           joints[regionAbove(joints, joint)].isOfTrunk();
}

} // namespace

std::vector<double> BinaryField::subtree(std::size_t joint) const {
    const std::vector<bool> inside = subtreeOf(joints, joint);
    std::vector<double> field(mesh.vertexCount());
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = inside[regions[v]] ? 1.0 : 0.0;
    return field;
}

std::vector<double> BinaryField::divided(std::size_t joint, double shift) const {
    std::vector<double> field = cut(joint, shift);
    if (!leavesTrunk(joints, joint)) return field;
    const std::vector<bool> isOwn = subtreeOf(joints, joint);
    for (std::size_t other = 1; other < joints.size(); ++other) {
        if (other == joint || !leavesTrunk(joints, other) ||
            regionAbove(joints, other) != regionAbove(joints, joint))
            continue;
        const std::vector<bool> isOther = subtreeOf(joints, other);
        const std::vector<double> others = cut(other, 0.0);
        for (std::size_t v = 0; v < field.size(); ++v) {
            if (!(field[v] + others[v] > 0.0)) continue;
            const double a = distanceToLimb(joints, isOwn, mesh.positions[v]);
            const double b = distanceToLimb(joints, isOther, mesh.positions[v]);
            if (std::abs(a - b) <= kMiddle * (a + b)) field[v] = 0.5;
        }
    }
    return field;
}

std::vector<double> BinaryField::cut(std::size_t joint, double shift) const {
    const PlannedJoint& planned = joints[joint];
    std::vector<double> field = subtree(joint);
    if (planned.topmost || !planned.beyond.empty() ||
        (planned.rigid >= 0 && planned.lengthAbove < planned.boneLength))
        return field;
    const glm::dvec3 normal = planeNormal(planned);
    std::vector<bool> isDivided(joints.size(), false);
    isDivided[joint] = true;
    if (planned.isSpine())
        for (std::size_t j = 0; j < joints.size(); ++j)
            isDivided[j] = joints[j].isSpine() || j == 0;
    for (std::size_t v = 0; v < field.size(); ++v) {
        if (!isDivided[regions[v]] || (!isWhole.empty() && isWhole[v])) continue;
        const double along = glm::dot(mesh.positions[v] - planned.centre, normal);
        field[v] = along > shift ? 1.0 : 0.0;
    }
    return field;
}

std::vector<double> BinaryField::bounded(std::size_t joint, double upper, double lower) const {
    std::vector<double> field = subtree(joint);
    if (joints[joint].topmost) return field;
    const glm::dvec3 normal = planeNormal(joints[joint]);
    const double length = std::max(joints[joint].boneLength, 1e-9 * mesh.size);
    const std::size_t above = regionAbove(joints, joint);
    for (std::size_t v = 0; v < field.size(); ++v) {
        if ((regions[v] != joint && regions[v] != above) || (!isWhole.empty() && isWhole[v]))
            continue;
        const double along = glm::dot(mesh.positions[v] - joints[joint].centre, normal) / length;
        field[v] = hermiteRatio((along - upper) / (lower - upper)); // eq. 5
    }
    return field;
}

std::vector<double> limbRadii(const BinaryField& binary) {
    std::vector<double> radii(binary.joints.size(), 0.0);
    for (std::size_t j = 1; j < radii.size(); ++j)
        if (binary.joints[j].holdsRegion()) radii[j] = limbRadius(binary, j);
    return radii;
}

bool isLimb(const PlannedJoint& joint, double radius) {
    return !joint.isOfTrunk() && !joint.isExtremity() && joint.rigid < 0 && joint.holdsRegion() &&
           joint.boneLength > kLimbLength * radius;
}

} // namespace osgSkin
