// SPDX-License-Identifier: MIT
#include "deform/Chain.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// A map in double precision, while a run of joints is being folded.
struct Fold {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 offset{0.0};
    double scale = 1.0;

    void append(const JointTransform& turn) {
        offset += scale * (rotation * turn.offset);
        rotation = rotation * turn.rotation;
        scale *= turn.scale;
    }
    Chain::Rigid rounded() const {
        return {glm::mat3(glm::mat3_cast(rotation)), glm::vec3(offset), static_cast<float>(scale)};
    }
};

Chain::Partial makePartial(const BoundJoint& joint, const JointTransform& turn) {
    const glm::dvec3 v = turn.split.bendAxis;
    const glm::dvec3 w = joint.twistAxis;
    return {glm::vec3(joint.centre),
            glm::vec3(turn.translation),
            glm::vec3(v),
            glm::vec3(w),
            glm::vec3(glm::cross(v, w)),
            static_cast<float>(0.5 * turn.split.bendAngle),
            static_cast<float>(0.5 * turn.split.twistAngle),
            static_cast<float>(turn.scale - 1.0)};
}

glm::vec3 rotate(float s, const glm::vec3& u, const glm::vec3& x) {
    const glm::vec3 t = 2.0f * glm::cross(u, x);
    return x + s * t + glm::cross(u, t);
}

} // namespace

Chain::Chain(const SkinModel& model, const SkinModel::Group& group, const Pose& pose) noexcept {
    Fold fold;
    for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
        const SkinModel::Link& link = model.links()[i];
        const JointTransform turn = pose.transform(link.joint);
        if (!link.partial) {
            fold.append(turn);
            continue;
        }
        full[partialCount] = fold.rounded();
        partial[partialCount] = makePartial(model.joints()[link.joint], turn);
        ++partialCount;
        fold = {};
    }
    full[partialCount] = fold.rounded();
}

void Chain::apply(const SkinModel::Ratio* ratios, glm::vec3& position, glm::vec3* normal,
                  glm::vec3* tangent) const noexcept {
    glm::vec3 x = full[partialCount] * position;
    glm::vec3 n = normal ? full[partialCount].rotation * *normal : glm::vec3(0.0f);
    glm::vec3 t = tangent ? full[partialCount].rotation * *tangent : glm::vec3(0.0f);
    for (std::size_t k = partialCount; k-- > 0;) {
        const Partial& joint = partial[k];
        // exp(b psi v / 2) exp(t phi w / 2) multiplied out; v . w = 0 (section 3 and eq. 1).
        const float a = ratios[k].bend * joint.halfBend;
        const float b = ratios[k].twist * joint.halfTwist;
        const float sa = std::sin(a), ca = std::cos(a);
        const float sb = std::sin(b), cb = std::cos(b);
        const glm::vec3 u =
            (sa * cb) * joint.bendAxis + (ca * sb) * joint.twistAxis + (sa * sb) * joint.crossAxis;
        const float s = ca * cb;
        // A translation and a scale of the joint, where the motion has them, come in with the bend.
        x = joint.centre + ratios[k].bend * joint.translation +
            (1.0f + ratios[k].bend * joint.growth) * rotate(s, u, x - joint.centre);
        x = full[k] * x;
        if (normal) n = full[k].rotation * rotate(s, u, n);
        if (tangent) t = full[k].rotation * rotate(s, u, t);
    }
    position = x;
    if (normal) *normal = n;
    if (tangent) *tangent = t;
}

} // namespace osgSkin
