// SPDX-License-Identifier: MIT
#include "pose/JointMotions.h"

#include "model/SkinModelAccess.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

void writeMap(JointMotion& joint) noexcept {
    const glm::dmat3 turn = glm::mat3_cast(joint.turn);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            joint.map.column[column].lane[row] =
                static_cast<float>(joint.scale * turn[column][row]);
        joint.map.column[column].lane[3] = 0.0f;
    }
    for (int row = 0; row < 3; ++row)
        joint.map.column[3].lane[row] = static_cast<float>(joint.move[row]);
    joint.map.column[3].lane[3] = 0.0f;
}

} // namespace

JointMotions::JointMotions(const SkinModel& model, const Pose& pose, JointMotion* room) noexcept
    : joints(room) {
    const double rounding = SkinModelAccess::blocks(model).smallMove;
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const JointTransform own = pose.transform(j);
        const int parent = model.joints()[j].parent;
        JointMotion& joint = room[j];
        joint.travel = joint.scaling = 0.0f;
        joint.growth = joint.growthHere = 1.0f;
        if (parent < 0) {
            joint.turn = own.rotation;
            joint.move = own.offset;
            joint.scale = own.scale;
        } else {
            const JointMotion& above = room[parent];
            joint.turn = above.turn * own.rotation;
            joint.move = above.move + above.scale * (above.turn * own.offset);
            joint.scale = above.scale * own.scale;
            joint.growthHere = above.growthHere;
            const double far = glm::dot(own.translation, own.translation);
            if (far > rounding * rounding) {
                joint.travel = static_cast<float>(std::sqrt(far));
                plain = false;
            }
        }
        writeMap(joint);
        joint.bend = static_cast<float>(own.split.bendAngle);
        joint.twist = static_cast<float>(own.split.twistAngle);
        const glm::vec3 v(own.split.bendAxis), w(model.joints()[j].twistAxis);
        joint.centre = four(glm::vec3(model.joints()[j].centre));
        joint.translation = four(glm::vec3(own.translation));
        joint.scaled = static_cast<float>(own.scale - 1.0);
        joint.bendAxis = four(v);
        joint.twistAxis = four(w);
        joint.crossAxis = four(glm::cross(v, w));
        if (own.scale == 1.0) continue;
        plain = false;
        joint.scaling = static_cast<float>(std::fabs(own.scale - 1.0));
        joint.growth = std::max(1.0f, static_cast<float>(own.scale));
        joint.growthHere *= joint.growth;
    }
}

} // namespace osgSkin
