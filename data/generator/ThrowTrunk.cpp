// SPDX-License-Identifier: MIT
#include "ThrowTrunk.h"

#include <glm/geometric.hpp>

namespace mannequin {
namespace {

struct Share {
    const char* joint;
    double part;
};

// The thoracic joints rotate more about the spine's axis than the lumbar joints.
constexpr Share kSpine[] = {{"LowerBack", 0.26}, {"Spine", 0.36}, {"Spine1", 0.38}};
constexpr Share kNeck[] = {{"Neck", 0.30}, {"Neck1", 0.34}, {"Head", 0.36}};

template <std::size_t N>
void share(const Skeleton& skeleton, const Share (&shares)[N], const glm::dquat& rotation,
           Pose& pose) {
    const glm::dquat whole = rotation.w < 0 ? -rotation : rotation;
    for (const Share& s : shares)
        pose.local[skeleton.index(s.joint)] = glm::slerp(glm::dquat(1, 0, 0, 0), whole, s.part);
}

} // namespace

void poseTrunk(const Skeleton& skeleton, const TrunkRotations& rotations, Pose& pose) {
    const auto& [pelvis, thorax, head] = rotations;
    pose.local[skeleton.index("Hips")] = pelvis;
    share(skeleton, kSpine, glm::inverse(pelvis) * thorax, pose);
    share(skeleton, kNeck, glm::inverse(thorax) * head, pose);
}

void poseTrunk(const Skeleton& skeleton, const BodyKeys& keys, double time, Pose& pose) {
    pose.root = {keys.x.at(time), keys.y.at(time), keys.z.at(time)};
    const glm::dquat pelvis =
        stance(keys.pelvisYaw.at(time), keys.pelvisLeanX.at(time), keys.pelvisLeanZ.at(time));
    const glm::dquat thorax =
        stance(keys.thoraxYaw.at(time), keys.thoraxLeanX.at(time), keys.thoraxLeanZ.at(time));
    const glm::dquat head = turn(keys.headYaw.at(time), {0, 1, 0}) *
                            turn(keys.headNod.at(time), {1, 0, 0}) *
                            turn(keys.headRoll.at(time), {0, 0, 1});
    poseTrunk(skeleton, {pelvis, thorax, head}, pose);
}

glm::dmat3 trunkFrame(const Skeleton& skeleton, const WorldPose& world) {
    const std::size_t thorax = skeleton.index("Spine1");
    const glm::dvec3 rise = skeleton.joint("Neck").centre - skeleton.joint("Hips").centre;
    const glm::dvec3 up =
        world.position[skeleton.index("Neck")] - world.position[skeleton.index("Hips")];
    const glm::dvec3 left = world.rotation[thorax] * glm::dvec3(1, 0, 0);
    const auto columns = [](const glm::dvec3& axis, const glm::dvec3& side) {
        const glm::dmat3 m = frameOf(axis, side); // up, left, backward
        return glm::dmat3(m[1], m[0], -m[2]);
    };
    // The spine leans slightly backward at rest; relative to that, the rest pose is upright.
    return columns(up, left) * glm::transpose(columns(rise, {1, 0, 0}));
}

} // namespace mannequin
