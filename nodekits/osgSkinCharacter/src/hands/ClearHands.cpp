// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinCharacter/ClearHands>

#include "hands/ArmTurn.h"
#include "hands/BodyPieces.h"

#include <osgSkin/Error>
#include <osgSkinRig/ForwardKinematics>

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace osgSkin {
namespace {

void check(const Clip& clip, const RestSkeleton& rest, const JointRoles& roles,
           const SkinMesh& mesh, const Binding& binding) {
    const std::size_t joints = rest.joints.size();
    const auto isJoint = [joints](std::uint32_t joint) { return joint < joints; };
    if (clip.joints != joints || clip.rotations.size() != clip.frames * joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error("clear hands: expected a clip of the skeleton's " + std::to_string(joints) +
                    " joints, found one of " + std::to_string(clip.joints));
    if (roles.roles.size() != joints)
        throw Error("clear hands: expected roles of the skeleton's joints");
    if (binding.regions.size() != mesh.positions.size() ||
        !std::all_of(binding.regions.begin(), binding.regions.end(), isJoint))
        throw Error("clear hands: expected a binding of the mesh to the skeleton");
}

double degrees(const glm::dquat& q) {
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), std::abs(q.w)));
}

PosedJoints restPose(const RestSkeleton& rest) {
    PosedJoints pose;
    for (const RestJoint& joint : rest.joints) pose.rest.push_back(joint.centre);
    pose.rotations.assign(pose.rest.size(), {1.0, 0.0, 0.0, 0.0});
    pose.centres = pose.rest;
    return pose;
}

} // namespace

std::string ClearedHands::text() const {
    std::ostringstream text;
    text.precision(3);
    text << turned << " of " << samples << " samples of arms turned, by " << meanDegrees
         << " degrees in the mean of all, " << largestDegrees << " at most";
    return text.str();
}

ClearedHands clearHands(Clip& clip, const RestSkeleton& rest, const JointRoles& roles,
                        const SkinMesh& mesh, const Binding& binding) {
    check(clip, rest, roles, mesh, binding);
    ClearedHands result;
    BodyPieces body = findBodyPieces(rest, roles, mesh, binding);
    PosedJoints pose = restPose(rest);
    for (BodySurface& surface : body.surfaces) surface.pose(pose);
    std::vector<ArmTurn> turns;
    turns.reserve(body.arms.size());
    for (const ArmPiece& arm : body.arms) turns.emplace_back(arm, body.surfaces, pose);

    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        worldRotations(rest, &clip.rotations[frame * clip.joints], pose.rotations);
        worldPositions(rest, pose.rotations, clip.rootPositions[frame], pose.centres);
        for (BodySurface& surface : body.surfaces) surface.pose(pose);
        for (std::size_t a = 0; a < turns.size(); ++a) {
            const glm::dquat turn = turns[a].find(pose);
            ++result.samples;
            if (isIdentity(turn)) continue; // to the last bit
            const std::size_t upper = body.arms[a].upper;
            const glm::dquat& above =
                pose.rotations[static_cast<std::size_t>(rest.joints[upper].parent)];
            clip.rotations[frame * clip.joints + upper] =
                glm::normalize(glm::conjugate(above) * turn * pose.rotations[upper]);
            ++result.turned;
            result.meanDegrees += degrees(turn);
            result.largestDegrees = std::max(result.largestDegrees, degrees(turn));
        }
    }
    if (result.samples > 0) result.meanDegrees /= double(result.samples);
    return result;
}

} // namespace osgSkin
