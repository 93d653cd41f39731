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
constexpr double kMostKnees = 40.0; // degrees, as the others
constexpr double kMostSpread = 35.0;
constexpr double kMostLean = 30.0;
constexpr double kMostTilt = 25.0;

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

int jointOf(const JointRoles& roles, const std::string& role) {
    const auto found = roles.joints.find(role);
    return found == roles.joints.end() ? -1 : found->second.front();
}

} // namespace

bool Stance::stands() const {
    return knees <= kMostKnees && spread <= kMostSpread && lean <= kMostLean && tilt <= kMostTilt;
}

double Stance::untidiness() const {
    return knees / kMostKnees + spread / kMostSpread + lean / kMostLean + tilt / kMostTilt +
           elbows / 90.0 + asymmetry / 45.0;
}

StanceJoints::StanceJoints(const JointRoles& roles) {
    const std::string sides[] = {"Left", "Right"};
    for (std::size_t s = 0; s < 2; ++s) {
        _legs[s] = {jointOf(roles, sides[s] + "UpperLeg"), jointOf(roles, sides[s] + "LowerLeg"),
                    jointOf(roles, sides[s] + "Foot")};
        _arms[s] = {jointOf(roles, sides[s] + "UpperArm"), jointOf(roles, sides[s] + "LowerArm"),
                    jointOf(roles, sides[s] + "Hand")};
    }
    for (const char* role : {"Neck", "Head"})
        if (_top < 0) _top = jointOf(roles, role);
    _complete = _legs[0].complete() && _legs[1].complete() &&
                (_top >= 0 || (_arms[0].complete() && _arms[1].complete()));
}

std::optional<Stance> StanceJoints::measure(const std::vector<glm::dvec3>& positions) const {
    const auto at = [&](int j) { return positions[static_cast<std::size_t>(j)]; };
    Stance result;
    glm::dvec3 ways[2];
    for (std::size_t s = 0; s < 2; ++s) {
        const Limb& leg = _legs[s];
        const glm::dvec3 thigh = at(leg.lower) - at(leg.upper);
        const glm::dvec3 shin = at(leg.end) - at(leg.lower);
        const glm::dvec3 whole = thigh + shin;
        if (!(glm::length(thigh) > 0.0 && glm::length(shin) > 0.0 && glm::length(whole) > 0.0))
            return std::nullopt;
        result.knees = std::max(result.knees, degreesBetween(thigh, shin));
        result.leg += 0.5 * (glm::length(thigh) + glm::length(shin));
        ways[s] = glm::normalize(whole);
    }
    const glm::dvec3 down = ways[0] + ways[1];
    if (!(glm::length(down) > 1e-6)) return std::nullopt;
    result.up = -glm::normalize(down);
    result.hips = 0.5 * (at(_legs[0].upper) + at(_legs[1].upper));
    result.lowest =
        std::min(glm::dot(at(_legs[0].end), result.up), glm::dot(at(_legs[1].end), result.up));
    result.spread = 0.5 * degreesBetween(ways[0], ways[1]);

    const glm::dvec3 top = _top >= 0 ? at(_top) : 0.5 * (at(_arms[0].upper) + at(_arms[1].upper));
    const glm::dvec3 across = at(_legs[0].upper) - at(_legs[1].upper);
    if (!(glm::length(top - result.hips) > 0.0 && glm::length(across) > 0.0)) return std::nullopt;
    result.lean = degreesBetween(top - result.hips, result.up);
    result.tilt = std::abs(90.0 - degreesBetween(across, result.up));

    double hang[2] = {0.0, 0.0};
    for (std::size_t s = 0; s < 2; ++s) {
        const Limb& arm = _arms[s];
        if (!_arms[0].complete() || !_arms[1].complete()) break;
        const glm::dvec3 upper = at(arm.lower) - at(arm.upper);
        result.elbows = std::max(result.elbows, degreesBetween(upper, at(arm.end) - at(arm.lower)));
        hang[s] = degreesBetween(upper, result.up);
    }
    result.asymmetry = std::abs(hang[0] - hang[1]);
    return result;
}

namespace {

constexpr double kUpOnFeet =
    0.6; ///< height of the hips above the feet of a standing actor, in leg lengths
constexpr double kOnFloor = 0.25; ///< the same of a body on the floor

} // namespace

StandingCheck::Legs::Legs(const JointRoles& roles) {
    const auto find = [&](const std::string& role) {
        const auto found = roles.joints.find(role);
        return found == roles.joints.end() ? -1 : found->second.front();
    };
    const std::string sides[] = {"Left", "Right"};
    for (int s = 0; s < 2; ++s) {
        upper[s] = find(sides[s] + "UpperLeg");
        lower[s] = find(sides[s] + "LowerLeg");
        foot[s] = find(sides[s] + "Foot");
    }
}

bool StandingCheck::Legs::complete() const {
    bool result = true;
    for (int s = 0; s < 2; ++s) result = result && upper[s] >= 0 && lower[s] >= 0 && foot[s] >= 0;
    return result;
}

double StandingCheck::Legs::height(const std::vector<glm::dvec3>& positions) const {
    double height = 0.0, length = 0.0;
    for (int s = 0; s < 2; ++s) {
        const glm::dvec3& hip = positions[static_cast<std::size_t>(upper[s])];
        const glm::dvec3& knee = positions[static_cast<std::size_t>(lower[s])];
        const glm::dvec3& ankle = positions[static_cast<std::size_t>(foot[s])];
        height += hip.y - ankle.y;
        length += glm::distance(hip, knee) + glm::distance(knee, ankle);
    }
    return length > 0.0 ? height / length : 0.0;
}

void StandingCheck::add(const std::vector<glm::dvec3>& rig, const std::vector<glm::dvec3>& motion) {
    if (!_rig.complete() || !_motion.complete() || _motion.height(motion) < kUpOnFeet) return;
    ++_standing;
    if (_rig.height(rig) < kOnFloor) ++_lying;
}

void StandingCheck::finish() const {
    if (2 * _lying <= _standing) return;
    throw Error("retarget: the rig's hips are as low as its feet in " + std::to_string(_lying) +
                " of the " + std::to_string(_standing) +
                " samples in which the actor stands; expected joints that match, in names, in the "
                "map and in how both skeletons rest");
}

} // namespace osgSkin
