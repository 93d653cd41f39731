// SPDX-License-Identifier: MIT
#include <osgSkin/Pose>

#include "SplitUnit.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// The rotation in a 3 x 3 matrix that may also scale; false where there is none to be found.
bool rotationOf(const glm::dmat3& m, glm::dquat& rotation) noexcept {
    glm::dvec3 x = m[0];
    glm::dvec3 y = m[1];
    const double xx = glm::dot(x, x);
    if (!std::isfinite(xx) || !(xx > 0.0)) return false;
    y -= x * (glm::dot(x, y) / xx);
    const double yy = glm::dot(y, y);
    if (!std::isfinite(yy) || !(yy > 1e-24 * xx)) return false;
    x *= 1.0 / std::sqrt(xx);
    y *= 1.0 / std::sqrt(yy);
    rotation = glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)));
    return true;
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// `twist` or a whole turn more or less, see Pose::Twist.
double continued(double before, double twist) noexcept {
    const double turn = 2.0 * glm::pi<double>();
    for (const double angle : {twist, twist + turn, twist - turn})
        if (std::abs(angle) < turn && std::abs(angle - before) <= 0.25 * turn) return angle;
    return twist;
}

} // namespace

Pose::Pose(const std::vector<BoundJoint>& joints)
    : _frames(joints.size(), Frame{{1.0, 0.0, 0.0, 0.0}, glm::dvec3(0.0)}), _turns(joints.size()) {
    _rest.reserve(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        _rest.push_back({joints[j].parent, joints[j].centre, glm::normalize(joints[j].twistAxis)});
        _turns[j].split = splitUnit(_turns[j].rotation, _rest[j].twistAxis);
    }
}

bool Pose::set(const glm::dmat4* skinning, std::size_t count, Twist twist) noexcept {
    if (count != _turns.size()) return false;
    for (std::size_t j = 0; j < count; ++j) {
        Frame frame;
        if (!rotationOf(glm::dmat3(skinning[j]), frame.rotation)) return false;
        // The joint centre goes where the whole matrix, scale included, puts it.
        const glm::dvec3 centre = _rest[j].centre;
        frame.offset = glm::dvec3(skinning[j] * glm::dvec4(centre, 1.0)) - frame.rotation * centre;
        if (!isFinite(frame.offset)) return false;
        _frames[j] = frame;
    }
    for (std::size_t j = 0; j < count; ++j) {
        // D_j = G_parent^-1 G_j; the root has no parent.
        const Rest& rest = _rest[j];
        const Frame& frame = _frames[j];
        Turn& turn = _turns[j];
        if (rest.parent < 0) {
            turn.rotation = frame.rotation;
            turn.offset = frame.offset;
            turn.translation = frame.offset;
        } else {
            const Frame& parent = _frames[static_cast<std::size_t>(rest.parent)];
            const glm::dquat back = glm::conjugate(parent.rotation);
            turn.rotation = back * frame.rotation;
            turn.offset = back * (frame.offset - parent.offset);
            turn.translation = turn.offset + turn.rotation * rest.centre - rest.centre;
        }
        const double before = turn.split.twistAngle;
        turn.split = splitUnit(turn.rotation, rest.twistAxis);
        if (twist == Twist::Continued)
            turn.split.twistAngle = continued(before, turn.split.twistAngle);
    }
    return true;
}

} // namespace osgSkin
