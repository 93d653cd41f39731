// SPDX-License-Identifier: MIT
#include <osgSkin/Pose>

#include <osgSkin/GlmOsg>

#include "model/SkinBlocks.h"
#include "pose/PoseKernel.h"

#include <osgSkin/GlmTypes>

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kSmallestScale = 1e-9; ///< and the largest is its inverse

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

} // namespace

Pose::Pose(const std::vector<BoundJoint>& joints, std::size_t inputs)
    : _count(joints.size()), _stride((_count + kAtOnce - 1) / kAtOnce * kAtOnce),
      _rows(kRows * _stride, 0.0), _azimuths(2 * _stride, 0), _inputs(inputs, 0.0f) {
    for (const Row one : {kW, kScale})
        std::fill_n(_rows.begin() + static_cast<std::ptrdiff_t>(one * _stride), _stride, 1.0);
    std::fill_n(_azimuths.begin(), _stride, 1 << 30);
    const auto rest = std::make_shared<RestRows>();
    rest->rows.resize(kRestRows * _stride);
    for (std::size_t j = 0; j < _stride; ++j) {
        const BoundJoint& joint = joints[std::min(j, _count - 1)];
        const glm::dmat3 frame = jointFrame(joint);
        rest->parents.push_back(joint.parent);
        const auto write = [&](RestRow row, const glm::dvec3& v) {
            for (int axis = 0; axis < 3; ++axis)
                rest->rows[(row + static_cast<std::size_t>(axis)) * _stride + j] = v[axis];
        };
        write(kCentre, joint.centre);
        write(kPole, frame[2]);
        write(kE1, frame[0]);
        write(kE2, frame[1]);
    }
    _rest = rest;
}

bool Pose::set(const glm::dmat4* skinning, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != _count) return false;
    bool other = false;
    if (count > 0) {
        static thread_local std::vector<double> room;
        const std::size_t stride = PoseFrames::kBefore + _stride;
        if (room.size() < kFrameRows * stride) room.resize(kFrameRows * stride);
        const PoseFrames frames{room.data() + PoseFrames::kBefore, stride};
        const PoseCall call = callFor(twist);
        if (!readFrames(skinning, call, frames)) return false;
        other = splitFrames(call, frames);
    }
    if (changed) *changed = other;
    return true;
}

PoseCall Pose::callFor(Twist twist) noexcept {
    return {_count,       _stride,          _rest->parents.data(),    _rest->rows.data(),
            _rows.data(), _azimuths.data(), twist == Twist::Continued};
}

bool Pose::set(const JointMap* own, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != _count) return false;
    static thread_local std::vector<Reach> reaches;
    if (reaches.size() < count) reaches.resize(count, Reach{0.0, 1.0});
    for (std::size_t j = 0; j < count; ++j) {
        const JointMap& map = own[j];
        const int parent = _rest->parents[j];
        const Reach& above = parent >= 0 ? reaches[static_cast<std::size_t>(parent)] : kNoReach;
        reaches[j] = {above.length + above.scale * lengthOf(map.offset), above.scale * map.scale};
        // Written so that NaN is refused.
        const glm::dquat& q = map.rotation;
        if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6) ||
            !isInRange(map.offset) || !(reaches[j].length <= kLargestCoordinate) ||
            !isScale(map.scale) || !isScale(reaches[j].scale))
            return false;
    }
    const bool other = count > 0 && splitMaps(callFor(twist), own);
    if (changed) *changed = other;
    return true;
}

bool Pose::setJoints(const Pose& other, bool* changed) noexcept {
    if (other._count != _count) return false;
    // What bends are follows from the rotations.
    const auto isSame = [&](Row first, Row end) {
        return std::equal(_rows.begin() + static_cast<std::ptrdiff_t>(first * _stride),
                          _rows.begin() + static_cast<std::ptrdiff_t>(end * _stride),
                          other._rows.begin() + static_cast<std::ptrdiff_t>(first * _stride));
    };
    const bool differs = !isSame(kW, kBend) || !isSame(kTwist, kRows);
    if (differs) {
        std::copy(other._rows.begin(), other._rows.end(), _rows.begin());
        std::copy(other._azimuths.begin(), other._azimuths.end(), _azimuths.begin());
    }
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
