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

struct Limb {
    std::size_t upper, hinge, end;
    std::vector<std::size_t> aboveHinge, aboveEnd; ///< joints between them, parents first
};

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

std::vector<Limb> findLimbs(const RestSkeleton& rig, const JointRoles& roles) {
    constexpr const char* kLimbs[][3] = {{"UpperArm", "LowerArm", "Hand"},
                                         {"UpperLeg", "LowerLeg", "Foot"}};
    std::vector<Limb> limbs;
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
                limbs.push_back({joints[0], joints[1], joints[2], *aboveHinge, *aboveEnd});
        }
    return limbs;
}

/// The equivalent angle that is nearest to another one.
double nearest(double angle, double to) {
    return angle + kTurn * std::round((to - angle) / kTurn);
}

/// One limb in one sample.
class LimbSample {
public:
    LimbSample(const RestSkeleton& rig, const Limb& limb, glm::dquat* local)
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

    double upperTwist() const { return twistAbout(_upperBone, _local[_limb.upper]); }
    double hingeTwist() const { return twistAbout(_lowerBone, _local[_limb.hinge]); }
    /// The end's twist about the lower bone.
    double endTwist() const {
        return twistAbout(glm::conjugate(_toEnd) * _lowerBone, _local[_limb.end]);
    }

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

private:
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

struct Twists {
    std::vector<double> upper, hinge, end; ///< [sample], unwrapped
};

/// Adds whole turns so that no angle is further than half a turn from the one before it, and the
/// middle one of all is within half a turn of 0.
void unwrap(std::vector<double>& angles) {
    for (std::size_t f = 1; f < angles.size(); ++f) angles[f] = nearest(angles[f], angles[f - 1]);
    std::vector<double> sorted = angles;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double shift = nearest(*middle, 0.0) - *middle;
    for (double& angle : angles) {
        angle += shift;
        if (std::abs(angle) > kMaxTwist) angle = nearest(angle, 0.0);
    }
}

} // namespace

double twistAbout(const glm::dvec3& axis, const glm::dquat& q) {
    const double sine = glm::dot(axis, glm::dvec3(q.x, q.y, q.z));
    return 2.0 * (q.w < 0.0 ? std::atan2(-sine, -q.w) : std::atan2(sine, q.w));
}

std::vector<std::size_t> shareHingeTwist(const RestSkeleton& rig, const JointRoles& roles,
                                         Clip& clip) {
    std::vector<std::size_t> shared(clip.joints, 0);
    for (const Limb& limb : findLimbs(rig, roles)) {
        std::vector<LimbSample> samples;
        Twists twists;
        samples.reserve(clip.frames);
        for (std::size_t f = 0; f < clip.frames; ++f) {
            const LimbSample& sample =
                samples.emplace_back(rig, limb, &clip.rotations[f * clip.joints]);
            if (!sample.isValid()) break;
            twists.upper.push_back(sample.upperTwist());
            twists.hinge.push_back(sample.hingeTwist());
            twists.end.push_back(sample.endTwist());
        }
        if (twists.hinge.size() < clip.frames || clip.frames == 0) continue;
        unwrap(twists.upper);
        unwrap(twists.hinge);
        unwrap(twists.end);
        for (std::size_t f = 0; f < clip.frames; ++f) {
            const double excess = std::abs(twists.hinge[f]) - kKept;
            if (!(excess > 0.0)) continue;
            ++shared[limb.hinge];
            const double sign = twists.hinge[f] < 0.0 ? -1.0 : 1.0;
            // Both get equal twists, or the one with less gets all.
            const double up =
                std::clamp(0.5 * (excess + sign * (twists.end[f] - twists.upper[f])), 0.0, excess);
            samples[f].take(sign * up, sign * (excess - up));
        }
    }
    return shared;
}

} // namespace osgSkin
