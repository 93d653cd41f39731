// SPDX-License-Identifier: MIT
#include "retarget/Posture.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgSkin {
namespace {

// Limits of a standing pose. Zero poses and scanned bodies have legs apart and knees slightly bent.
constexpr double kMaxKnees = 40.0; // degrees, as the others
constexpr double kMaxSpread = 35.0;
constexpr double kMaxLean = 30.0;
constexpr double kMaxTilt = 25.0;

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// The limbs of both sides, such as "UpperLeg", "LowerLeg" and "Foot".
LimbPair limbsOf(const JointRoles& roles, const char* upper, const char* lower, const char* end) {
    LimbPair result;
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string side = s == 0 ? "Left" : "Right";
        result[s] = {roles.joint(side + upper), roles.joint(side + lower), roles.joint(side + end)};
    }
    return result;
}

LimbPair legsOf(const JointRoles& roles) {
    return limbsOf(roles, "UpperLeg", "LowerLeg", "Foot");
}

bool isComplete(const LimbPair& limbs) {
    return limbs[0].complete() && limbs[1].complete();
}

/// Height of the hips above the feet, in leg lengths.
double hipHeight(const LimbPair& legs, const std::vector<glm::dvec3>& positions) {
    double height = 0.0, length = 0.0;
    for (const LimbJoints& leg : legs) {
        const glm::dvec3& hip = positions[static_cast<std::size_t>(leg.upper)];
        const glm::dvec3& knee = positions[static_cast<std::size_t>(leg.lower)];
        const glm::dvec3& ankle = positions[static_cast<std::size_t>(leg.end)];
        height += hip.y - ankle.y;
        length += glm::distance(hip, knee) + glm::distance(knee, ankle);
    }
    return length > 0.0 ? height / length : 0.0;
}

// Heights of the hips above the feet, in leg lengths.
constexpr double kUpOnFeet = 0.6; ///< of a standing actor
constexpr double kOnFloor = 0.25; ///< of a body on the floor

} // namespace

bool Posture::stands() const {
    return standsLeaning() && lean <= kMaxLean;
}

bool Posture::standsLeaning() const {
    return knees <= kMaxKnees && spread <= kMaxSpread && lean <= 90.0 && tilt <= kMaxTilt;
}

double Posture::untidiness() const {
    return knees / kMaxKnees + spread / kMaxSpread + lean / kMaxLean + tilt / kMaxTilt +
           elbows / 90.0 + asymmetry / 45.0;
}

PostureJoints::PostureJoints(const JointRoles& roles)
    : _legs(legsOf(roles)), _arms(limbsOf(roles, "UpperArm", "LowerArm", "Hand")) {
    for (const char* role : {"Neck", "Head"})
        if (_top < 0) _top = roles.joint(role);
    _complete = isComplete(_legs) && (_top >= 0 || isComplete(_arms));
}

std::optional<Posture> PostureJoints::measure(const std::vector<glm::dvec3>& positions) const {
    const auto at = [&](int j) { return positions[static_cast<std::size_t>(j)]; };
    Posture result;
    glm::dvec3 directions[2];
    for (std::size_t s = 0; s < 2; ++s) {
        const LimbJoints& leg = _legs[s];
        const glm::dvec3 thigh = at(leg.lower) - at(leg.upper);
        const glm::dvec3 shin = at(leg.end) - at(leg.lower);
        const glm::dvec3 whole = thigh + shin;
        if (!(glm::length(thigh) > 0.0 && glm::length(shin) > 0.0 && glm::length(whole) > 0.0))
            return std::nullopt;
        result.knees = std::max(result.knees, degreesBetween(thigh, shin));
        result.leg += 0.5 * (glm::length(thigh) + glm::length(shin));
        directions[s] = glm::normalize(whole);
    }
    const glm::dvec3 down = directions[0] + directions[1];
    if (!(glm::length(down) > 1e-6)) return std::nullopt;
    result.up = -glm::normalize(down);
    result.hips = 0.5 * (at(_legs[0].upper) + at(_legs[1].upper));
    result.lowest =
        std::min(glm::dot(at(_legs[0].end), result.up), glm::dot(at(_legs[1].end), result.up));
    result.spread = 0.5 * degreesBetween(directions[0], directions[1]);

    const glm::dvec3 top = _top >= 0 ? at(_top) : 0.5 * (at(_arms[0].upper) + at(_arms[1].upper));
    const glm::dvec3 across = at(_legs[0].upper) - at(_legs[1].upper);
    result.trunk = top - result.hips;
    if (!(glm::length(result.trunk) > 0.0 && glm::length(across) > 0.0)) return std::nullopt;
    result.left = glm::normalize(across);
    result.lean = degreesBetween(result.trunk, result.up);
    result.tilt = std::abs(90.0 - degreesBetween(across, result.up));

    double hang[2] = {0.0, 0.0};
    for (std::size_t s = 0; s < 2; ++s) {
        const LimbJoints& arm = _arms[s];
        if (!_arms[0].complete() || !_arms[1].complete()) break;
        const glm::dvec3 upper = at(arm.lower) - at(arm.upper);
        result.elbows = std::max(result.elbows, degreesBetween(upper, at(arm.end) - at(arm.lower)));
        hang[s] = degreesBetween(upper, result.up);
    }
    result.asymmetry = std::abs(hang[0] - hang[1]);
    return result;
}

StandingCheck::StandingCheck(const JointRoles& rig, const JointRoles& motion)
    : _rig(legsOf(rig)), _motion(legsOf(motion)) {}

void StandingCheck::add(const std::vector<glm::dvec3>& rig, const std::vector<glm::dvec3>& motion) {
    if (!isComplete(_rig) || !isComplete(_motion) || hipHeight(_motion, motion) < kUpOnFeet) return;
    ++_standing;
    if (hipHeight(_rig, rig) < kOnFloor) ++_lying;
}

void StandingCheck::finish() const {
    if (2 * _lying <= _standing) return;
    throw Error("retarget: the rig's hips are as low as its feet in " + std::to_string(_lying) +
                " of the " + std::to_string(_standing) +
                " samples in which the actor stands; expected joints that match, in names, in the "
                "map and in how both skeletons rest");
}

} // namespace osgSkin
