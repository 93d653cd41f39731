// SPDX-License-Identifier: GPL-3.0-or-later
#include "limbs/LimbRadius.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// A limb's length is at least this many radii: upper arms have three to four, necks less than two.
constexpr double kLimbLength = 2.2;

double limbRadius(const BinaryField& binary, std::size_t joint) {
    const WeldedMesh& mesh = binary.mesh;
    const PlannedJoint& bone = binary.joints[joint];
    const std::vector<double> field = binary.divided(joint);
    std::vector<double> radii; // one for each edge across the division
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        if (field[v] < 0.5) continue;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
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

} // namespace

std::vector<double> limbRadii(const BinaryField& binary) {
    std::vector<double> radii(binary.joints.size(), 0.0);
    for (std::size_t j = 1; j < radii.size(); ++j)
        if (binary.joints[j].holdsRegion) radii[j] = limbRadius(binary, j);
    return radii;
}

bool isLimb(const PlannedJoint& joint, double radius) {
    return !joint.trunk && !joint.extremity && joint.rigid < 0 && joint.holdsRegion &&
           joint.boneLength > kLimbLength * radius;
}

} // namespace osgSkin
