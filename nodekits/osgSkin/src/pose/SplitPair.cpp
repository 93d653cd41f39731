// SPDX-License-Identifier: MIT
#include "pose/SplitPair.h"

#include "points/Two.h"
#include "pose/SplitUnit.h"

#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

/// Bend axes are nothing below this sine of half the bend.
constexpr double kNoBend = 1e-100;
/// Below this cosine of half the bend, its axis and the twist are not told apart.
constexpr double kHalfTurn = 1e-12;

SplitAngles splitAlone(const glm::dquat& q, const PoseAccess::Rest& rest) noexcept {
    const BendTwist split = splitUnit(q, rest.twistAxis);
    return {split.bendAngle, split.twistAngle, glm::dot(split.bendAxis, rest.e1),
            glm::dot(split.bendAxis, rest.e2)};
}

} // namespace

void splitPair(const glm::dquat* const (&q)[2], const PoseAccess::Rest* const (&rest)[2],
               SplitAngles (&angles)[2]) noexcept {
    const Two x = two(q[0]->x, q[1]->x), y = two(q[0]->y, q[1]->y), z = two(q[0]->z, q[1]->z);
    const auto along = [&](const glm::dvec3& a, const glm::dvec3& b) {
        return x * two(a.x, b.x) + y * two(a.y, b.y) + z * two(a.z, b.z);
    };
    // c + s w is the twist, u1 e1 + u2 e2 what is perpendicular to w; of q and -q the one where c
    // is positive.
    Two c = two(q[0]->w, q[1]->w);
    Two s = along(rest[0]->twistAxis, rest[1]->twistAxis);
    Two u1 = along(rest[0]->e1, rest[1]->e1), u2 = along(rest[0]->e2, rest[1]->e2);
    const Two::Mask negative = c.v < 0.0;
    for (Two* part : {&c, &s, &u1, &u2}) part->v = negative ? -part->v : part->v;
    const Two cosine = sqrt(c * c + s * s), sine = sqrt(u1 * u1 + u2 * u2);
    const Two bend = both(2.0) * angleOf(sine, cosine);
    const Two twist = both(2.0) * angleOf(s, c);
    // q times the inverse twist: eq. 3.
    const Two length = sine * cosine;
    const Two right = (c * u1 - s * u2) / length, up = (c * u2 + s * u1) / length;
    for (int i = 0; i < 2; ++i) {
        if (c[i] == 0.0 || cosine[i] < kHalfTurn)
            angles[i] = splitAlone(*q[i], *rest[i]);
        else if (sine[i] < kNoBend)
            angles[i] = {0.0, twist[i], 1.0, 0.0};
        else
            angles[i] = {bend[i], twist[i], right[i], up[i]};
    }
}

} // namespace osgSkin
