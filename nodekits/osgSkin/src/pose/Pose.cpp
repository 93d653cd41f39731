// SPDX-License-Identifier: MIT
#include <osgSkin/Pose>

#include <osgSkin/GlmOsg>

#include "model/SkinBlocks.h"
#include "pose/PoseKernel.h"

#include <osgSkin/GlmTypes>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace osgSkin {
namespace {

constexpr double kSmallestScale = 1e-9; ///< and the largest is its inverse

/// A bound of how far a joint's map moves the origin, and its scale, with all joints above.
struct Reach {
    double length;
    double scale;
};
constexpr Reach kNoReach{0.0, 1.0};

/// An upper bound of a vector's length, without a root.
double lengthOf(const glm::dvec3& v) noexcept {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

bool isScale(double scale) noexcept {
    return scale >= kSmallestScale && scale <= 1.0 / kSmallestScale; // false for NaN
}

/// How far a pose can move vertices, which may follow any of its joints in part.
struct Spread {
    /// The limit for the product of all growing scales.
    static constexpr double kMaxGrown = 1e12;

    double grown = 1.0; ///< the product of all scales above 1
    double moved = 0.0; ///< the sum of all translations, before scaling

    void add(const Reach& own) noexcept {
        moved += own.scale > 1.0 ? own.length / own.scale : own.length;
        if (own.scale > 1.0) grown *= own.scale;
    }
    bool isInRange() const noexcept { // false for NaN
        return grown <= kMaxGrown && grown * moved <= kLargestCoordinate;
    }
};

/// Whether frames, each of which is in range, are in range together.
bool isInRange(const PoseFrames& frames, const int* parents, std::size_t count) noexcept {
    const auto row = [&](std::size_t number) { return frames.rows + number * frames.stride; };
    const double* const scales = row(12);
    if (std::all_of(scales, scales + count, [](double scale) { return scale == 1.0; })) return true;
    Spread spread;
    for (std::size_t j = 0; j < count; ++j) {
        const std::ptrdiff_t parent = parents[j]; // -1: no turn
        const glm::dvec3 shift(row(9)[j] - row(9)[parent], row(10)[j] - row(10)[parent],
                               row(11)[j] - row(11)[parent]);
        spread.add({lengthOf(shift) / scales[parent], scales[j] / scales[parent]});
    }
    return spread.isInRange();
}

/// A padded copy of a pose with fewer joints than are processed at a time; repeats the last one.
class FewJoints {
    static constexpr std::size_t kAtOnce = PoseCall::kAtOnce;

public:
    explicit FewJoints(const PoseCall& of) : _of(of) {
        for (std::size_t j = 0; j < kAtOnce; ++j) {
            _parents[j] = of.parents[last(j)];
            for (std::size_t row = 0; row < PoseAccess::kRestRows; ++row)
                _rest[row * kAtOnce + j] = of.rest[row * of.count + last(j)];
            for (std::size_t row = 0; row < PoseAccess::kNumberRows; ++row)
                _rows[row * kAtOnce + j] = of.rows[row * of.count + last(j)];
        }
    }

    PoseCall call() {
        return {kAtOnce, _parents.data(), _rest.data(), _rows.data(), _of.continued};
    }

    template <typename T>
    std::array<T, kAtOnce> padded(const T* joints) const {
        std::array<T, kAtOnce> result;
        for (std::size_t j = 0; j < kAtOnce; ++j) result[j] = joints[last(j)];
        return result;
    }

    void write() const {
        for (std::size_t row = 0; row < PoseAccess::kNumberRows; ++row)
            std::copy_n(&_rows[row * kAtOnce], _of.count, _of.rows + row * _of.count);
        constexpr std::size_t kSize = sizeof(std::int32_t);
        auto* const to = reinterpret_cast<char*>(_of.rows + PoseAccess::kNumberRows * _of.count);
        const auto* const from =
            reinterpret_cast<const char*>(_rows.data() + PoseAccess::kNumberRows * kAtOnce);
        for (std::size_t row = 0; row < 2; ++row)
            std::memcpy(to + row * _of.count * kSize, from + row * kAtOnce * kSize,
                        _of.count * kSize);
    }

private:
    std::size_t last(std::size_t joint) const { return std::min(joint, _of.count - 1); }

    PoseCall _of;
    std::array<int, kAtOnce> _parents;
    std::array<double, PoseAccess::kRestRows * kAtOnce> _rest;
    std::array<double, PoseAccess::kRows * kAtOnce> _rows;
};

/// \param count of the joints, without padding
/// \return false where the matrices cannot be used
bool setFrom(const glm::dmat4* skinning, const PoseCall& call, std::size_t count,
             bool& other) noexcept {
    static thread_local std::vector<double> room;
    const std::size_t stride = PoseFrames::kBefore + call.count;
    if (room.size() < kFrameRows * stride) room.resize(kFrameRows * stride);
    const PoseFrames frames{room.data() + PoseFrames::kBefore, stride};
    if (!readFrames(skinning, call, frames) || !isInRange(frames, call.parents, count))
        return false;
    other = splitFrames(call, frames);
    return true;
}

} // namespace

Pose::Pose(const std::vector<BoundJoint>& joints, std::size_t inputs)
    : _rows(kRows * joints.size(), 0.0), _inputs(inputs, 0.0f) {
    const std::size_t count = joints.size();
    for (const Row one : {kW, kScale})
        std::fill_n(_rows.begin() + static_cast<std::ptrdiff_t>(one * count), count, 1.0);
    const std::vector<std::int32_t> none(count, 1 << 30);
    if (count > 0) std::memcpy(&_rows[kAzimuth * count], none.data(), count * sizeof(std::int32_t));
    const auto rest = std::make_shared<RestRows>();
    rest->rows.resize(kRestRows * count);
    for (std::size_t j = 0; j < count; ++j) {
        const glm::dmat3 frame = jointFrame(joints[j]);
        rest->parents.push_back(joints[j].parent);
        const auto write = [&](RestRow row, const glm::dvec3& v) {
            for (int axis = 0; axis < 3; ++axis)
                rest->rows[(row + static_cast<std::size_t>(axis)) * count + j] = v[axis];
        };
        write(kCentre, joints[j].centre);
        write(kPole, frame[2]);
        write(kE1, frame[0]);
        write(kE2, frame[1]);
    }
    _rest = rest;
}

PoseCall Pose::callFor(Twist twist) noexcept {
    return {size(), _rest->parents.data(), _rest->rows.data(), _rows.data(),
            twist == Twist::Continued};
}

bool Pose::set(const glm::dmat4* skinning, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != size()) return false;
    bool other = false;
    if (count >= PoseCall::kAtOnce) {
        if (!setFrom(skinning, callFor(twist), count, other)) return false;
    } else if (count > 0) {
        FewJoints few(callFor(twist));
        if (!setFrom(few.padded(skinning).data(), few.call(), count, other)) return false;
        few.write();
    }
    if (changed) *changed = other;
    return true;
}

bool Pose::set(const JointMap* own, std::size_t count, Twist twist, bool* changed) noexcept {
    if (count != size()) return false;
    static thread_local std::vector<Reach> reaches;
    if (reaches.size() < count) reaches.resize(count, Reach{0.0, 1.0});
    Spread spread;
    for (std::size_t j = 0; j < count; ++j) {
        const JointMap& map = own[j];
        const int parent = _rest->parents[j];
        const Reach& above = parent >= 0 ? reaches[static_cast<std::size_t>(parent)] : kNoReach;
        const Reach reach{lengthOf(map.offset), map.scale};
        reaches[j] = {above.length + above.scale * reach.length, above.scale * reach.scale};
        spread.add(reach);
        // Rejects NaN.
        const glm::dquat& q = map.rotation;
        if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6) ||
            !isInRange(map.offset) || !(reaches[j].length <= kLargestCoordinate) ||
            !isScale(map.scale) || !isScale(reaches[j].scale))
            return false;
    }
    if (!spread.isInRange()) return false;
    bool other = false;
    if (count >= PoseCall::kAtOnce) {
        other = splitMaps(callFor(twist), own);
    } else if (count > 0) {
        FewJoints few(callFor(twist));
        other = splitMaps(few.call(), few.padded(own).data());
        few.write();
    }
    if (changed) *changed = other;
    return true;
}

bool Pose::setJoints(const Pose& other, bool* changed) noexcept {
    const std::size_t count = size();
    if (other.size() != count) return false;
    // Bends follow from the rotations.
    const auto isSame = [&](Row first, Row end) {
        return std::equal(_rows.begin() + static_cast<std::ptrdiff_t>(first * count),
                          _rows.begin() + static_cast<std::ptrdiff_t>(end * count),
                          other._rows.begin() + static_cast<std::ptrdiff_t>(first * count));
    };
    const bool differs = !isSame(kW, kBend) || !isSame(kTwist, kAzimuth);
    if (differs) std::memcpy(_rows.data(), other._rows.data(), _rows.size() * sizeof(double));
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

std::vector<glm::dmat4> Pose::skinning() const {
    std::vector<glm::dmat4> result;
    result.reserve(size());
    for (std::size_t j = 0; j < size(); ++j) {
        const Split split = splitOf(j);
        const glm::dmat4 own = glm::translate(glm::dmat4(1.0), split.offset) *
                               glm::mat4_cast(split.rotation) *
                               glm::scale(glm::dmat4(1.0), glm::dvec3(split.scale));
        const int parent = _rest->parents[j];
        result.push_back(parent < 0 ? own : result[static_cast<std::size_t>(parent)] * own);
    }
    return result;
}

} // namespace osgSkin
