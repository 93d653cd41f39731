// SPDX-License-Identifier: MIT
#include "bounds/JointMotions.h"

#include "pose/PoseAccess.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

Four narrowed(const glm::dvec3& v) noexcept {
    return four(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f);
}

Four cross(const Four& a, const Four& b) noexcept {
    return four(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
                0.0f);
}

/// What is a rounding error is nothing: products of such numbers would be denormal, and slow.
Four flushed(const Four& a) noexcept {
    return {abs(a).v < 1e-12f ? all(0.0f).v : a.v};
}
float flushed(double angle) noexcept {
    return std::fabs(angle) < 1e-9 ? 0.0f : static_cast<float>(angle);
}

float lengthOf(const Four& a) noexcept {
    const Four squares = a * a;
    return std::sqrt(squares[0] + squares[1] + squares[2]);
}

} // namespace

JointMotions::JointMotions(const BoundsProxy& proxy, const Pose& pose, JointMotion* room) noexcept
    : _proxy(proxy), _pose(pose), _joints(room) {
    for (std::size_t j = 0; j < proxy.joints.size(); ++j) {
        const BoundsProxy::Joint& rest = proxy.joints[j];
        if (!rest.isNeeded) continue;
        const PoseAccess::Split& own = PoseAccess::split(pose, j);
        JointMotion& joint = room[j];
        const glm::dquat& q = own.rotation;
        FourMap map = rotation(static_cast<float>(q.w), static_cast<float>(q.x),
                               static_cast<float>(q.y), static_cast<float>(q.z));
        for (int i = 0; i < 3; ++i) map.column[i] = flushed(map.column[i]);
        joint.travel = joint.scaling = joint.scaled = 0.0f;
        joint.growth = joint.growthHere = 1.0f;
        if (own.scale != 1.0) {
            _plain = false;
            const auto scale = static_cast<float>(own.scale);
            for (int i = 0; i < 3; ++i) map.column[i] = scale * map.column[i];
            joint.scaled = static_cast<float>(own.scale - 1.0);
            joint.scaling = std::fabs(joint.scaled);
            joint.growth = joint.growthHere = std::max(1.0f, scale);
        }
        map.column[3] = narrowed(own.offset);
        if (rest.parent < 0) {
            joint.map = map;
        } else {
            const JointMotion& above = room[rest.parent];
            joint.translation = map * rest.centre - rest.centre;
            joint.map = above.map * map;
            joint.growthHere *= above.growthHere;
            const float travel = lengthOf(joint.translation);
            if (!(travel <= proxy.noTravel)) { // NaN too
                joint.travel = travel;
                _plain = false;
            }
        }
        joint.bend = flushed(own.bendAngle);
        joint.twist = std::fabs(flushed(own.twistAngle));
    }
}

FourMap JointMotions::partialTurn(const BoundsProxy::Term& term) noexcept {
    JointMotion& joint = _joints[term.joint];
    const BoundsProxy::Joint& rest = _proxy.joints[term.joint];
    const PoseAccess::Split& own = PoseAccess::split(_pose, term.joint);
    if (term.joint >= kKnown || !_known[term.joint]) {
        const PoseAccess::Rest& frame = PoseAccess::rest(_pose, term.joint);
        const auto cosine = static_cast<float>(PoseAccess::kAzimuthStep * own.azimuthCosine);
        const auto sine = static_cast<float>(PoseAccess::kAzimuthStep * own.azimuthSine);
        joint.bendAxis = cosine * narrowed(frame.e1) + sine * narrowed(frame.e2);
        joint.crossAxis = cross(joint.bendAxis, rest.twistAxis);
        if (term.joint < kKnown) _known.set(term.joint);
    }
    const float a = 0.5f * term.bend * joint.bend;
    const float b = 0.5f * term.twist * static_cast<float>(own.twistAngle);
    const float sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
    const Four u =
        (sa * cb) * joint.bendAxis + (ca * sb) * rest.twistAxis + (sa * sb) * joint.crossAxis;
    FourMap map = rotation(ca * cb, u[0], u[1], u[2]);
    if (joint.scaled != 0.0f)
        for (int i = 0; i < 3; ++i)
            map.column[i] = (1.0f + term.bend * joint.scaled) * map.column[i];
    map.column[3] = rest.centre - map.turn(rest.centre);
    if (joint.travel != 0.0f) map.column[3] = map.column[3] + term.bend * joint.translation;
    return map;
}

} // namespace osgSkin
