// SPDX-License-Identifier: MIT
#include "retarget/MotionSteps.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace osgSkin {
namespace {

constexpr double kTurn = glm::two_pi<double>();
constexpr double kKept = 0.25 * kTurn;     ///< largest twist that a hinge keeps
constexpr double kMaxTwist = 0.75 * kTurn; ///< 90 degrees in each of the three joints
/// Of a bone without direction, over the longest bone of the limb.
constexpr double kNoLength = 1e-6;

/// The joints between two joints, parents first; nothing where `below` is no descendant of `above`.
std::optional<std::vector<std::size_t>> between(const RestSkeleton& rig, std::size_t above,
                                                std::size_t below) {
    std::vector<std::size_t> result;
    int j = rig.joints[below].parent;
    for (; j >= 0 && j != static_cast<int>(above);
         j = rig.joints[static_cast<std::size_t>(j)].parent)
        result.push_back(static_cast<std::size_t>(j));
    if (j < 0) return std::nullopt;
    std::reverse(result.begin(), result.end());
    return result;
}

/// The equivalent angle that is nearest to another one.
double nearest(double angle, double to) {
    return angle + kTurn * std::round((to - angle) / kTurn);
}

/// The equivalent angles that are nearest to others, or to 0 if they are too large.
glm::dvec3 continued(const glm::dvec3& twists, const glm::dvec3& before) {
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i) {
        result[i] = nearest(twists[i], before[i]);
        if (std::abs(result[i]) > kMaxTwist) result[i] = nearest(result[i], 0.0);
    }
    return result;
}

} // namespace

double twistAbout(const glm::dvec3& axis, const glm::dquat& q) {
    const double sine = glm::dot(axis, glm::dvec3(q.x, q.y, q.z));
    return 2.0 * (q.w < 0.0 ? std::atan2(-sine, -q.w) : std::atan2(sine, q.w));
}

/// One limb in one pose.
class HingeTwist::LimbPose {
public:
    LimbPose(const RestSkeleton& rig, const Limb& limb, glm::dquat* local)
        : _limb(limb), _local(local) {
        _upperBone = boneOf(rig, limb.upper, limb.aboveHinge, limb.hinge, _toHinge);
        _lowerBone = boneOf(rig, limb.hinge, limb.aboveEnd, limb.end, _toEnd);
        const double longest = std::max(glm::length(_upperBone), glm::length(_lowerBone));
        _valid = std::min(glm::length(_upperBone), glm::length(_lowerBone)) > kNoLength * longest;
        if (!_valid) return;
        _upperBone = glm::normalize(_upperBone);
        _lowerBone = glm::normalize(_lowerBone);
    }

    /// Whether both bones have a direction.
    bool isValid() const { return _valid; }

    /// Of the upper joint and the hinge about their bones, and of the end about the lower bone.
    glm::dvec3 twists() const {
        return {twistAbout(_upperBone, _local[_limb.upper]), hingeTwist(),
                twistAbout(glm::conjugate(_toEnd) * _lowerBone, _local[_limb.end])};
    }

    /// Distributes what the hinge has too much.
    /// \param twists as twists() has them, or with whole turns more
    /// \return whether it had too much
    bool share(const glm::dvec3& twists) {
        const double excess = std::abs(twists[1]) - kKept;
        if (!(excess > 0.0)) return false;
        const double sign = twists[1] < 0.0 ? -1.0 : 1.0;
        // Both get equal twists, or the one with less gets all.
        const double up = std::clamp(0.5 * (excess + sign * (twists[2] - twists[0])), 0.0, excess);
        take(sign * up, sign * (excess - up));
        return true;
    }

private:
    double hingeTwist() const { return twistAbout(_lowerBone, _local[_limb.hinge]); }

    /// Moves the twists `up` and `down` from the hinge to the joint above and to the end.
    void take(double up, double down) {
        glm::dquat& hinge = _local[_limb.hinge];
        if (up != 0.0) {
            const double angle = upperAngle(up);
            _local[_limb.upper] =
                glm::normalize(_local[_limb.upper] * glm::angleAxis(angle, _upperBone));
            hinge = glm::angleAxis(-angle, glm::conjugate(_toHinge) * _upperBone) * hinge;
        }
        hinge = glm::normalize(hinge * glm::angleAxis(-down, _lowerBone));
        _local[_limb.end] = glm::normalize(
            glm::angleAxis(down, glm::conjugate(_toEnd) * _lowerBone) * _local[_limb.end]);
    }

    /// From a joint to a descendant, in the joint's frame; `to` is the rotation of the last joint
    /// between them.
    glm::dvec3 boneOf(const RestSkeleton& rig, std::size_t from,
                      const std::vector<std::size_t>& path, std::size_t end, glm::dquat& to) const {
        glm::dvec3 bone(0.0);
        std::size_t above = from;
        to = glm::dquat(1.0, 0.0, 0.0, 0.0);
        for (const std::size_t j : path) {
            bone += to * (rig.joints[j].centre - rig.joints[above].centre);
            to = to * _local[j];
            above = j;
        }
        return bone + to * (rig.joints[end].centre - rig.joints[above].centre);
    }

    /// The twist of the upper joint that takes `up` off the hinge's twist: the same angle where
    /// both bones are in line at rest.
    double upperAngle(double up) const {
        const glm::dquat q = _local[_limb.hinge] *
                             glm::angleAxis(up - hingeTwist(), _lowerBone); // left with twist `up`
        const glm::dvec3 v(q.x, q.y, q.z);
        const glm::dvec3 axis = glm::conjugate(_toHinge) * _upperBone;
        const double sine = glm::dot(v, _lowerBone);
        const double cosine =
            q.w * glm::dot(axis, _lowerBone) + glm::dot(glm::cross(axis, v), _lowerBone);
        return nearest(2.0 * std::atan2(sine, cosine), up);
    }

    const Limb& _limb;
    glm::dquat* _local; ///< [joint]
    glm::dquat _toHinge, _toEnd;
    glm::dvec3 _upperBone, _lowerBone; ///< in the upper joint's frame and in the hinge's, unit
    bool _valid = false;
};

HingeTwist::HingeTwist(const RestSkeleton& rig, const JointRoles& roles) : _rig(rig) {
    constexpr const char* kLimbs[][3] = {{"UpperArm", "LowerArm", "Hand"},
                                         {"UpperLeg", "LowerLeg", "Foot"}};
    for (const std::string side : {"Left", "Right"})
        for (const auto& parts : kLimbs) {
            std::size_t joints[3];
            bool isKnown = true;
            for (int i = 0; i < 3; ++i) {
                const int joint = roles.joint(side + parts[i]);
                isKnown = isKnown && joint >= 0;
                joints[i] = static_cast<std::size_t>(joint);
            }
            if (!isKnown) continue;
            auto aboveHinge = between(rig, joints[0], joints[1]);
            auto aboveEnd = between(rig, joints[1], joints[2]);
            if (aboveHinge && aboveEnd)
                _limbs.push_back({joints[0], joints[1], joints[2], *aboveHinge, *aboveEnd});
        }
}

std::vector<std::size_t> HingeTwist::share(Clip& clip) const {
    std::vector<std::size_t> shared(clip.joints, 0);
    for (const Limb& limb : _limbs) {
        std::vector<LimbPose> poses;
        std::vector<glm::dvec3> twists; // unwrapped
        poses.reserve(clip.frames);
        for (std::size_t f = 0; f < clip.frames; ++f) {
            const LimbPose& pose = poses.emplace_back(_rig, limb, &clip.rotations[f * clip.joints]);
            if (!pose.isValid()) break;
            glm::dvec3 next = pose.twists();
            for (int i = 0; f > 0 && i < 3; ++i) next[i] = nearest(next[i], twists.back()[i]);
            twists.push_back(next);
        }
        if (twists.size() < clip.frames || clip.frames == 0) continue;
        glm::dvec3 shift; // of the middle angles to within half a turn of 0
        for (int i = 0; i < 3; ++i) {
            std::vector<double> sorted;
            sorted.reserve(twists.size());
            for (const glm::dvec3& each : twists) sorted.push_back(each[i]);
            const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
            std::nth_element(sorted.begin(), middle, sorted.end());
            shift[i] = nearest(*middle, 0.0) - *middle;
        }
        for (std::size_t f = 0; f < clip.frames; ++f)
            if (poses[f].share(continued(twists[f], twists[f] + shift))) ++shared[limb.hinge];
    }
    return shared;
}

void HingeTwist::shareNext(glm::dquat* local) {
    for (Limb& limb : _limbs) {
        LimbPose pose(_rig, limb, local);
        if (!pose.isValid()) continue;
        limb.last = continued(pose.twists(), limb.last);
        pose.share(limb.last);
    }
}

void HingeTwist::restart() {
    for (Limb& limb : _limbs) limb.last = glm::dvec3(0.0);
}

} // namespace osgSkin
