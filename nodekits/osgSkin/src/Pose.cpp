// SPDX-License-Identifier: MIT
#include <osgSkin/Pose>

#include "SkinBlocks.h"
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

Pose::Pose(const std::vector<BoundJoint>& joints) : _splits(joints.size()) {
    const auto rest = std::make_shared<std::vector<Rest>>();
    rest->reserve(joints.size());
    for (const BoundJoint& joint : joints) {
        const glm::dmat3 frame = jointFrame(joint);
        rest->push_back({joint.parent, joint.centre, frame[2], frame[0], frame[1]});
    }
    _rest = rest;
}

bool Pose::set(const glm::dmat4* skinning, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != _splits.size()) return false;
    struct Frame { // of G_j
        glm::dquat rotation;
        glm::dvec3 offset;
    };
    static thread_local std::vector<Frame> frames;
    if (frames.size() < count) frames.resize(count, Frame{{1.0, 0.0, 0.0, 0.0}, glm::dvec3(0.0)});
    for (std::size_t j = 0; j < count; ++j) {
        Frame& frame = frames[j];
        if (!rotationOf(glm::dmat3(skinning[j]), frame.rotation)) return false;
        // The joint centre goes where the whole matrix, scale included, puts it.
        const glm::dvec3& centre = (*_rest)[j].centre;
        frame.offset = glm::dvec3(skinning[j] * glm::dvec4(centre, 1.0)) - frame.rotation * centre;
        if (!isFinite(frame.offset)) return false;
    }
    bool other = false;
    for (std::size_t j = 0; j < count; ++j) {
        // D_j = G_parent^-1 G_j; the root has no parent.
        const Rest& rest = (*_rest)[j];
        Split now;
        now.rotation = frames[j].rotation;
        now.offset = frames[j].offset;
        if (rest.parent >= 0) {
            const Frame& parent = frames[static_cast<std::size_t>(rest.parent)];
            const glm::dquat back = glm::conjugate(parent.rotation);
            now.rotation = back * now.rotation;
            now.offset = back * (now.offset - parent.offset);
        }
        const BendTwist split = splitUnit(now.rotation, rest.twistAxis);
        now.azimuthCosine = glm::dot(split.bendAxis, rest.e1);
        now.azimuthSine = glm::dot(split.bendAxis, rest.e2);
        now.bendAngle = split.bendAngle;
        now.twistAngle = split.twistAngle;
        Split& before = _splits[j];
        if (twist == Twist::Continued)
            now.twistAngle = continued(before.twistAngle, now.twistAngle);
        other = other || now.rotation != before.rotation || now.offset != before.offset ||
                now.twistAngle != before.twistAngle;
        before = now;
    }
    if (changed) *changed = other;
    return true;
}

} // namespace osgSkin
