// SPDX-License-Identifier: GPL-3.0-or-later
#include "limbs/BinaryField.h"

#include "limbs/HermiteRatio.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {

std::vector<double> BinaryField::subtree(std::size_t joint) const {
    const std::vector<bool> inside = subtreeOf(joints, joint);
    std::vector<double> field(mesh.vertexCount());
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = inside[regions[v]] ? 1.0 : 0.0;
    return field;
}

std::vector<double> BinaryField::divided(std::size_t joint, double shift) const {
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

} // namespace osgSkin
