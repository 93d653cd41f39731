// SPDX-License-Identifier: MIT
//
// Included by BoundsKernel.cpp once for each instruction set.
#if defined(OSGSKIN_JOINTMOTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_JOINTMOTIONS_INL_H
#undef OSGSKIN_JOINTMOTIONS_INL_H
#else
#define OSGSKIN_JOINTMOTIONS_INL_H
#endif

#include <hwy/highway.h>

#include "bounds/JointMotion.h"
#include "model/BoundsProxy.h"
#include "pose/PoseAccess.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

constexpr auto kAzimuthStep = static_cast<float>(PoseAccess::kAzimuthStep);

HWY_INLINE Four narrowed(const glm::dvec3& v) noexcept {
    return four(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f);
}

/// What is a rounding error is nothing: products of such numbers would be denormal, and slow.
HWY_INLINE Four flushed(const Four& a) noexcept {
    return {abs(a).v < 1e-8f ? all(0.0f).v : a.v};
}
HWY_INLINE float flushed(double angle) noexcept {
    return std::fabs(angle) < 1e-9 ? 0.0f : static_cast<float>(angle);
}

HWY_INLINE float lengthOf(const Four& a) noexcept {
    const Four squares = a * a;
    return std::sqrt(squares[0] + squares[1] + squares[2]);
}

/// The same of the joints that a proxy needs.
class JointMotions {
public:
    /// \param proxy of the pose's model
    /// \param pose of the model's joints
    /// \param room for as many as the pose has joints
    JointMotions(const BoundsProxy& proxy, const Pose& pose, JointMotion* room) noexcept;

    const JointMotion& operator[](std::uint32_t joint) const noexcept { return _joints[joint]; }

    /// But for the root none is moved or scaled, nor is that scaled.
    bool isPlain() const noexcept { return _plain; }

    /// The map of a joint's turn by ratios.
    FourMap partialTurn(const BoundsProxy::Term& term) const noexcept;

private:
    const BoundsProxy& _proxy;
    JointMotion* _joints;
    bool _plain = true;
};

HWY_INLINE JointMotions::JointMotions(const BoundsProxy& proxy, const Pose& pose,
                                      JointMotion* room) noexcept
    : _proxy(proxy), _joints(room) {
    for (std::size_t j = 0; j < proxy.joints.size(); ++j) {
        const BoundsProxy::Joint& rest = proxy.joints[j];
        if (!rest.isNeeded) continue;
        const PoseAccess::Split& own = PoseAccess::split(pose, j);
        JointMotion& joint = room[j];
        const glm::dquat& q = own.rotation;
        FourMap map = rotation(flushed(four(static_cast<float>(q.x), static_cast<float>(q.y),
                                            static_cast<float>(q.z), static_cast<float>(q.w))));
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
            const Four way = abs(joint.translation);
            if (!(way[0] + way[1] + way[2] <= proxy.noTravel)) { // NaN too
                joint.travel = lengthOf(joint.translation);
                _plain = false;
            }
        }
        joint.bend = flushed(own.bendAngle);
        joint.signedTwist = flushed(own.twistAngle);
        joint.twist = std::fabs(joint.signedTwist);
        joint.square = (joint.bend + joint.twist) * (joint.bend + joint.twist);
        joint.cosine = static_cast<float>(own.azimuthCosine) * kAzimuthStep;
        joint.sine = static_cast<float>(own.azimuthSine) * kAzimuthStep;
    }
}

HWY_INLINE FourMap JointMotions::partialTurn(const BoundsProxy::Term& term) const noexcept {
    const JointMotion& joint = _joints[term.joint];
    const BoundsProxy::Joint& rest = _proxy.joints[term.joint];
    // The bend v with its axis cosine e1 + sine e2, after the twist about w; v x w is
    // sine e1 - cosine e2.
    const Four of =
        sinesAndCosines(0.5f * term.bend * joint.bend, 0.5f * term.twist * joint.signedTwist);
    const float right = of[0] * of[3], up = of[0] * of[1];
    Four q = (right * joint.cosine + up * joint.sine) * rest.e1 +
             (right * joint.sine - up * joint.cosine) * rest.e2 + (of[2] * of[1]) * rest.twistAxis;
    q.v[3] = of[2] * of[3];
    FourMap map = rotation(q);
    if (joint.scaled != 0.0f)
        for (int i = 0; i < 3; ++i)
            map.column[i] = (1.0f + term.bend * joint.scaled) * map.column[i];
    map.column[3] = rest.centre - map.turn(rest.centre);
    if (joint.travel != 0.0f) map.column[3] = map.column[3] + term.bend * joint.translation;
    return map;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
