// SPDX-License-Identifier: MIT
#include "WristTwist.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace quality {
namespace {

/// An edge moves where its length changes by more than this share; single precision is far below.
constexpr double kMoved = 1e-5;

double movedStrain(const Subject& subject, const compare::Points& posed) {
    double squares = 0.0, count = 0.0;
    for (const compare::Edge& edge : subject.edges) {
        const double length = glm::distance(subject.rest[edge[0]], subject.rest[edge[1]]);
        if (!(length > 0.0)) continue;
        const double strain = glm::distance(posed[edge[0]], posed[edge[1]]) / length - 1.0;
        if (std::abs(strain) < kMoved) continue;
        squares += strain * strain;
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// From just below the elbow to just above the wrist.
std::vector<std::vector<EdgePoint>> forearmLoops(const Subject& subject, const glm::dvec3& elbow,
                                                 const glm::dvec3& wrist) {
    std::vector<std::vector<EdgePoint>> loops;
    for (int percent = 10; percent <= 95; percent += 5)
        loops.push_back(crossSection(subject, glm::mix(elbow, wrist, 0.01 * percent),
                                     glm::normalize(wrist - elbow)));
    return loops;
}

void add(const Subject& subject, const std::string& side, std::vector<WristTwist>& twists) {
    const int forearm = subject.joint(side + "ForeArm"), hand = subject.joint(side + "Hand");
    if (forearm < 0 || hand < 0) return;
    const osgSkin::BoundJoint& wrist = subject.binding.joints[static_cast<std::size_t>(hand)];
    const glm::dvec3 elbow = subject.rig.joints[static_cast<std::size_t>(forearm)].centre;
    const CrossSections sections(subject, static_cast<std::size_t>(hand),
                                 forearmLoops(subject, elbow, wrist.centre));
    for (WristTwist& twist : twists) {
        const auto skinning = singleTurn(subject, static_cast<std::size_t>(hand), wrist.twistAxis,
                                         glm::radians(twist.degrees));
        for (const Method method : kMethods) {
            const compare::Points posed = deform(subject, method, skinning);
            twist.strain[method] = std::max(twist.strain[method], movedStrain(subject, posed));
            const CrossSections::Least least = sections.leastAreas(method, skinning, posed);
            CrossSections::Least& worst = twist.leastArea[method];
            worst.ofMethod = std::min(worst.ofMethod, least.ofMethod);
            worst.ofMesh = std::min(worst.ofMesh, least.ofMesh);
        }
    }
}

} // namespace

std::vector<WristTwist> measureWristTwists(const Subject& subject) {
    if (subject.joint("LeftHand") < 0 && subject.joint("RightHand") < 0) return {};
    std::vector<WristTwist> twists;
    for (const double degrees : {60.0, 120.0, 170.0}) twists.push_back({degrees, {}, {}});
    for (const std::string side : {"Left", "Right"}) add(subject, side, twists);
    return twists;
}

} // namespace quality
