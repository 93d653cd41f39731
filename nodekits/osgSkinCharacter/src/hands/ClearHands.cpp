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

/// Where a hand passes the middle of a limb the shortest way out changes sides: turns are blended
/// over so many seconds before and after.
constexpr double kBlend = 0.06;

/// The axis times the angle in radians.
glm::dvec3 toVector(const glm::dquat& q) {
    const glm::dvec3 axis = (q.w < 0.0 ? -1.0 : 1.0) * glm::dvec3(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine > 0.0 ? 2.0 * std::atan2(sine, std::abs(q.w)) / sine * axis : axis;
}

/// Blended over time, nearer samples more; zero, to the last bit, where all that are near are.
glm::dvec3 blended(const std::vector<glm::dvec3>& turns, std::size_t frame, double frameTime) {
    const auto reach = static_cast<std::ptrdiff_t>(frameTime > 0.0 ? kBlend / frameTime : 0.0);
    const auto at = static_cast<std::ptrdiff_t>(frame);
    const auto last = static_cast<std::ptrdiff_t>(turns.size()) - 1;
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (auto i = std::max<std::ptrdiff_t>(0, at - reach); i <= std::min(last, at + reach); ++i) {
        const double weight = double(reach + 1 - std::abs(i - at));
        sum += weight * turns[static_cast<std::size_t>(i)];
        weights += weight;
    }
    return sum / weights;
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

    // [arm][sample], in the axes of the joint above
    std::vector<std::vector<glm::dvec3>> found(turns.size(), std::vector<glm::dvec3>(clip.frames));
    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        worldRotations(rest, &clip.rotations[frame * clip.joints], pose.rotations);
        worldPositions(rest, pose.rotations, clip.rootPositions[frame], pose.centres);
        for (BodySurface& surface : body.surfaces) surface.pose(pose);
        for (std::size_t a = 0; a < turns.size(); ++a) {
            const std::size_t upper = body.arms[a].upper;
            const glm::dquat& above =
                pose.rotations[static_cast<std::size_t>(rest.joints[upper].parent)];
            found[a][frame] = glm::conjugate(above) * toVector(turns[a].find(pose));
        }
    }
    for (std::size_t a = 0; a < turns.size(); ++a)
        for (std::size_t frame = 0; frame < clip.frames; ++frame) {
            ++result.samples;
            const glm::dvec3 turn = blended(found[a], frame, clip.frameTime);
            const double angle = glm::length(turn);
            if (!(angle > 0.0)) continue; // to the last bit
            glm::dquat& rotation = clip.rotations[frame * clip.joints + body.arms[a].upper];
            rotation = glm::normalize(glm::angleAxis(angle, turn / angle) * rotation);
            ++result.turned;
            result.meanDegrees += glm::degrees(angle);
            result.largestDegrees = std::max(result.largestDegrees, glm::degrees(angle));
        }
    if (result.samples > 0) result.meanDegrees /= double(result.samples);
    return result;
}

} // namespace osgSkin
