// SPDX-License-Identifier: MIT
#include "arms/BodyPieces.h"

#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>

#include <array>
#include <limits>
#include <string>

namespace osgSkin {

PosedJoints::PosedJoints(const RestSkeleton& skeleton) {
    for (const RestJoint& joint : skeleton.joints) rest.push_back(joint.centre);
    rotations.assign(rest.size(), {1.0, 0.0, 0.0, 0.0});
    centres = rest;
}

void PosedJoints::set(const RestSkeleton& skeleton, const Clip& clip, std::size_t frame) {
    worldRotations(skeleton, &clip.rotations[frame * clip.joints], rotations);
    worldPositions(skeleton, rotations, rest.front(), clip.moves, frame, centres);
}

namespace {

constexpr std::size_t kPoints = 45; ///< of upper arm, forearm and hand each
constexpr double kFirstAlong = 0.2; ///< the upper arm's skin above is pressed in the armpit

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

BodyPiece pieceOf(const std::string& role) {
    const bool left = role.compare(0, 4, "Left") == 0;
    if (role == "Hips" || role == "Spine" || role == "Neck" || endsWith(role, "Collar") ||
        endsWith(role, "HipJoint"))
        return BodyPiece::Trunk;
    if (role == "Head") return BodyPiece::Head;
    if (endsWith(role, "UpperLeg")) return left ? BodyPiece::LeftThigh : BodyPiece::RightThigh;
    if (endsWith(role, "UpperArm")) return left ? BodyPiece::LeftArm : BodyPiece::RightArm;
    return BodyPiece::Other;
}

std::vector<BodyPiece> piecesOf(const RestSkeleton& rest, const JointRoles& roles) {
    const std::size_t count = rest.joints.size();
    std::vector<bool> leadsOn(count, false); // to a joint with a role
    std::vector<bool> isLeaf(count, true);
    for (std::size_t j = count; j-- > 1;) {
        const auto parent = static_cast<std::size_t>(rest.joints[j].parent);
        isLeaf[parent] = false;
        if (leadsOn[j] || !roles.roles[j].empty()) leadsOn[parent] = true;
    }
    std::vector<BodyPiece> result(count, BodyPiece::Other);
    for (std::size_t j = 0; j < count; ++j) {
        const int parent = rest.joints[j].parent;
        const BodyPiece above =
            parent < 0 ? BodyPiece::Other : result[static_cast<std::size_t>(parent)];
        const bool isHelper = roles.roles[j].empty() && (leadsOn[j] || isLeaf[j]);
        if (above == BodyPiece::LeftArm || above == BodyPiece::RightArm || isHelper)
            result[j] = above;
        else if (!roles.roles[j].empty())
            result[j] = pieceOf(roles.roles[j]);
    }
    return result;
}

/// Adds at most kPoints of the points, by farthest point sampling.
void addSpread(const std::vector<ArmPiece::Point>& points, std::vector<ArmPiece::Point>& result) {
    std::vector<double> distances(points.size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    for (std::size_t k = 0; k < std::min(kPoints, points.size()); ++k) {
        result.push_back(points[next]);
        for (std::size_t i = 0; i < points.size(); ++i)
            distances[i] =
                std::min(distances[i], glm::distance(points[i].place, result.back().place));
        next = static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) -
                                        distances.begin());
        if (distances[next] <= 0.0) break; // only duplicates are left
    }
}

double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double s = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(p, a + s * along);
}

/// The arm of one side, without held things: points farther from the forearm than its length.
ArmPiece armOf(const RestSkeleton& rest, const JointRoles& roles, const std::string& side,
               const SkinMesh& mesh, const Binding& binding) {
    ArmPiece arm;
    const int upper = roles.joint(side + "UpperArm"), lower = roles.joint(side + "LowerArm");
    const int hand = roles.joint(side + "Hand");
    if (upper <= 0 || lower < 0 || hand < 0 || !rest.isInSubtree(lower, upper)) return arm;
    const auto centre = [&rest](int j) { return rest.joints[std::size_t(j)].centre; };
    const glm::dvec3 shoulder = centre(upper), elbow = centre(lower), wrist = centre(hand);
    const glm::dvec3 axis = elbow - shoulder;
    const double forearm = glm::distance(elbow, wrist);
    if (!(forearm > 0.0) || !(glm::length(axis) > 0.0)) return arm;
    arm.upper = std::size_t(upper);
    arm.lower = std::size_t(lower);
    arm.length = glm::length(axis) + forearm;
    arm.palm = {glm::dvec3(0.0), std::size_t(hand)};
    std::array<std::vector<ArmPiece::Point>, 3> skin; // upper arm, forearm, hand
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const int joint = int(binding.regions[v]);
        ArmPiece::Point point{mesh.positions[v], binding.regions[v]};
        if (!rest.isInSubtree(joint, upper)) continue;
        const bool isUpper = !rest.isInSubtree(joint, lower);
        if (isUpper) point.along = glm::dot(point.place - shoulder, axis) / glm::dot(axis, axis);
        if (isUpper ? point.along > kFirstAlong
                    : distanceToSegment(point.place, elbow, wrist) < forearm)
            skin[isUpper ? 0 : rest.isInSubtree(joint, hand) ? 2 : 1].push_back(point);
    }
    for (const auto& part : skin) addSpread(part, arm.points);
    for (const ArmPiece::Point& point : skin[2])
        arm.palm.place += point.place / double(skin[2].size());
    if (skin[2].empty()) arm.palm.place = wrist;
    return arm;
}

} // namespace

BodyPieces::BodyPieces(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                       const Binding& binding)
    : ofJoint(piecesOf(rest, roles)) {
    for (const char* side : {"Left", "Right"})
        arms.push_back(armOf(rest, roles, side, mesh, binding));
    if (arms[0].points.empty() && arms[1].points.empty()) arms.clear();
}

} // namespace osgSkin
