// SPDX-License-Identifier: GPL-3.0-or-later
#include "limbs/MiddleThird.h"

#include <glm/geometric.hpp>

namespace osgSkin {

MiddleThird::MiddleThird(const BinaryField& binary, std::size_t joint) {
    const PlannedJoint& bone = binary.joints[joint];
    const std::vector<double> below = binary.divided(joint);
    std::vector<double> beyond(below.size(), 0.0);
    if (bone.child >= 0) beyond = binary.divided(static_cast<std::size_t>(bone.child));
    for (std::uint32_t v = 0; v < below.size(); ++v) {
        if (below[v] < 0.5 || beyond[v] >= 0.5) continue;
        const double along =
            glm::dot(binary.mesh.positions[v] - bone.centre, bone.boneAxis) / bone.boneLength;
        if (along >= 1.0 / 3.0 && along <= 2.0 / 3.0) _vertices.push_back(v);
    }
}

double MiddleThird::mean(const std::vector<double>& field) const {
    double sum = 0.0;
    for (const std::uint32_t v : _vertices) sum += field[v];
    return sum / static_cast<double>(_vertices.size());
}

} // namespace osgSkin
