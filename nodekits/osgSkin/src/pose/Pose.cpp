// SPDX-License-Identifier: MIT
#include <osgSkin/Pose>

#include <osgSkin/GlmOsg>

#include "model/SkinBlocks.h"
#include "pose/SplitPair.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kSmallestScale = 1e-9; ///< and the largest is its inverse
/// Of what a matrix makes of a cube.
constexpr double kSmallestVolume = 1e-27;

/// How far a joint's map can move the origin, at most, and how it scales, all above it included.
struct Reach {
    double length;
    double scale;
};
constexpr Reach kNoReach{0.0, 1.0};

/// Not below the length of a vector, in less time.
double lengthOf(const glm::dvec3& v) noexcept {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

bool isScale(double scale) noexcept {
    return scale >= kSmallestScale && scale <= 1.0 / kSmallestScale; // false for NaN
}

/// What a skinning matrix is: x -> offset + scale * rotation * x. As a matrix: which part of a
/// quaternion is to be found first differs from joint to joint, but for a joint's own rotation it
/// is nearly always the same one.
struct Frame {
    glm::dmat3 rotation{1.0};
    glm::dvec3 offset{0.0};
    double scale = 1.0;
};

/// The rotation in a 3 x 3 matrix that may also scale, and the uniform part of that scale; false
/// where there is none to be found.
bool rotationOf(const glm::dmat3& m, glm::dmat3& rotation, double& scale) noexcept {
    glm::dvec3 x = m[0];
    glm::dvec3 y = m[1];
    const double xx = glm::dot(x, x);
    if (!std::isfinite(xx) || !(xx > 0.0)) return false;
    y -= x * (glm::dot(x, y) / xx);
    const double yy = glm::dot(y, y);
    if (!std::isfinite(yy) || !(yy > 1e-24 * xx)) return false;
    const double volume = std::abs(glm::dot(glm::cross(x, y), glm::dvec3(m[2])));
    if (!(volume >= kSmallestVolume && volume <= 1.0 / kSmallestVolume)) return false; // NaN too
    // What numbers of a file or rotation are rounded by is no scale; and a root takes its time.
    scale = std::abs(volume - 1.0) < 3e-6 ? 1.0 : std::cbrt(volume);
    x *= 1.0 / std::sqrt(xx);
    y *= 1.0 / std::sqrt(yy);
    rotation = {x, y, glm::cross(x, y)};
    return true;
}

/// Whether a matrix maps places to places, near enough.
bool isAffine(const glm::dmat4& m) noexcept {
    constexpr double rounding = 1e-3;
    return std::abs(m[0][3]) < rounding && std::abs(m[1][3]) < rounding &&
           std::abs(m[2][3]) < rounding && std::abs(m[3][3] - 1.0) < rounding; // false for NaN
}

/// A sine or cosine as a whole number of steps of 2^-30: as good as the kernel's floats, in half of
/// a double's room.
std::int32_t inSteps(double x) noexcept {
    return static_cast<std::int32_t>(std::lrint(x * double(1 << 30)));
}

/// `twist` or 2 pi more or less, see Pose::Twist.
double continued(double before, double twist) noexcept {
    const double turn = 2.0 * glm::pi<double>();
    for (const double angle : {twist, twist + turn, twist - turn})
        if (std::abs(angle) < turn && std::abs(angle - before) <= 0.25 * turn) return angle;
    return twist;
}

} // namespace

Pose::Pose(const std::vector<BoundJoint>& joints, std::size_t inputs)
    : _splits(joints.size()), _inputs(inputs, 0.0f) {
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
    static thread_local std::vector<Frame> frames;  // G_j
    static thread_local std::vector<JointMap> maps; // D_j
    if (frames.size() < count) {
        frames.resize(count);
        maps.resize(count);
    }
    for (std::size_t j = 0; j < count; ++j) {
        Frame& frame = frames[j];
        if (!rotationOf(glm::dmat3(skinning[j]), frame.rotation, frame.scale)) return false;
        // The joint centre goes where the whole matrix, non-uniform scale included, puts it.
        const glm::dvec3& centre = (*_rest)[j].centre;
        frame.offset = glm::dvec3(skinning[j] * glm::dvec4(centre, 1.0)) -
                       frame.scale * (frame.rotation * centre);
        if (!isInRange(frame.offset) || !isAffine(skinning[j])) return false;
    }
    for (std::size_t j = 0; j < count; ++j) {
        // D_j = G_parent^-1 G_j; the root has no parent.
        const Rest& rest = (*_rest)[j];
        const Frame& frame = frames[j];
        JointMap& now = maps[j];
        if (rest.parent < 0) {
            now = {glm::quat_cast(frame.rotation), frame.offset, frame.scale};
            continue;
        }
        const Frame& parent = frames[static_cast<std::size_t>(rest.parent)];
        const glm::dmat3 back = glm::transpose(parent.rotation);
        now = {glm::quat_cast(back * frame.rotation), back * (frame.offset - parent.offset),
               frame.scale};
        if (now.scale == parent.scale && now.scale == 1.0) continue;
        now.offset /= parent.scale;
        now.scale /= parent.scale;
        if (std::abs(now.scale - 1.0) < 1e-6) now.scale = 1.0;
    }
    const bool other = take(maps.data(), twist);
    if (changed) *changed = other;
    return true;
}

bool Pose::take(const JointMap* own, Twist twist) noexcept {
    bool other = false;
    const std::size_t count = _splits.size();
    for (std::size_t first = 0; first < count; first += 2) {
        const std::size_t joints[2] = {first, std::min(first + 1, count - 1)};
        SplitAngles angles[2];
        splitPair({&own[joints[0]].rotation, &own[joints[1]].rotation},
                  {&(*_rest)[joints[0]], &(*_rest)[joints[1]]}, angles);
        for (std::size_t i = 0; i < 2 && first + i < count; ++i) {
            const JointMap& map = own[first + i];
            Split& before = _splits[first + i];
            Split now;
            now.rotation = map.rotation;
            now.offset = map.offset;
            now.scale = map.scale;
            now.azimuthCosine = inSteps(angles[i].azimuthCosine);
            now.azimuthSine = inSteps(angles[i].azimuthSine);
            now.bendAngle = angles[i].bend;
            now.twistAngle = twist == Twist::Continued
                                 ? continued(before.twistAngle, angles[i].twist)
                                 : angles[i].twist;
            other = other || !isSame(now, before);
            before = now;
        }
    }
    return other;
}

bool Pose::isSame(const Split& a, const Split& b) noexcept {
    return a.rotation == b.rotation && a.offset == b.offset && a.scale == b.scale &&
           a.twistAngle == b.twistAngle;
}

bool Pose::set(const JointMap* own, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != _splits.size()) return false;
    static thread_local std::vector<Reach> reaches;
    if (reaches.size() < count) reaches.resize(count, Reach{0.0, 1.0});
    for (std::size_t j = 0; j < count; ++j) {
        const JointMap& map = own[j];
        const int parent = (*_rest)[j].parent;
        const Reach& above = parent >= 0 ? reaches[static_cast<std::size_t>(parent)] : kNoReach;
        reaches[j] = {above.length + above.scale * lengthOf(map.offset), above.scale * map.scale};
        // Written so that NaN is refused.
        const glm::dquat& q = map.rotation;
        if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6) ||
            !isInRange(map.offset) || !(reaches[j].length <= kLargestCoordinate) ||
            !isScale(map.scale) || !isScale(reaches[j].scale))
            return false;
    }
    const bool other = take(own, twist);
    if (changed) *changed = other;
    return true;
}

bool Pose::setJoints(const Pose& other, bool* changed) noexcept {
    if (other._splits.size() != _splits.size()) return false;
    const bool differs = !std::equal(_splits.begin(), _splits.end(), other._splits.begin(), isSame);
    if (differs) std::copy(other._splits.begin(), other._splits.end(), _splits.begin());
    if (changed) *changed = differs;
    return true;
}

bool Pose::setInput(std::size_t input, float value) noexcept {
    if (input >= _inputs.size() || !std::isfinite(value)) return false;
    _inputs[input] = value;
    return true;
}

bool Pose::set(const osg::Matrixd* skinning, std::size_t count, Twist twist,
               bool* changed) noexcept {
    return set(asGlm(skinning), count, twist, changed);
}

} // namespace osgSkin
