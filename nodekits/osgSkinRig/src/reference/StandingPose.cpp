// SPDX-License-Identifier: MIT
#include "reference/StandingPose.h"

#include "reference/CountedFrom.h"
#include "reference/Stance.h"
#include "skeleton/NearAxis.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgSkin {
namespace {

/// Of long motions, so many samples are looked at.
constexpr std::size_t kMostSamples = 4000;

/// A body that no sample shows standing may come near: what a pose is off by, untidiness() of it.
constexpr double kNearlyStands = 5.0;

constexpr int kPlusY = 2; ///< as nearAxis() has it

constexpr const char* kNeverAlong =
    "the actor's legs are never along the axis of the motion's zero pose: he lies, or the zero "
    "pose does";

std::vector<glm::dvec3> centresOf(const RestSkeleton& skeleton) {
    std::vector<glm::dvec3> result;
    for (const RestJoint& joint : skeleton.joints) result.push_back(joint.centre);
    return result;
}

/// What the samples of a motion show of its actor.
struct Samples {
    std::map<int, std::size_t> standing; ///< axis -> samples that stand along it
    std::map<int, std::size_t> grounded; ///< of them, with the feet on a floor through the origin
    std::map<int, std::size_t> along;    ///< axis -> samples with the legs along it, however bent
    std::size_t all = 0;

    int axis = 0;         ///< along which most stand; +y where that is up and some do
    bool isKnown = false; ///< whether it is that

    /// The tidiest sample along `axis`, or of all where none stands.
    std::size_t best = 0;
    std::optional<Stance> bestStance;
};

class Sampler {
public:
    Sampler(const Motion& motion, const StanceJoints& joints) : _motion(motion), _joints(joints) {}

    Samples look() {
        Samples result;
        const std::size_t step = std::max<std::size_t>(1, _motion.frames / kMostSamples);
        std::vector<std::pair<std::size_t, Stance>> stances;
        for (std::size_t f = 0; f < _motion.frames; f += step) {
            const auto stance = measure(f);
            ++result.all;
            if (!stance) continue;
            stances.emplace_back(f, *stance);
            const int axis = nearAxis(stance->up);
            if (axis != 0) ++result.along[axis];
            if (!stance->stands() || axis == 0) continue;
            ++result.standing[axis];
            const double height = glm::dot(stance->hips, stance->up) / stance->leg;
            if (height > 0.5 && height < 1.7 && std::abs(stance->lowest) < 0.4 * stance->leg)
                ++result.grounded[axis];
        }
        std::size_t most = 0;
        for (const auto& [axis, count] : result.standing)
            if (count > most) {
                most = count;
                result.axis = axis;
            }
        result.isKnown = _motion.yIsUp && result.standing.count(kPlusY) > 0;
        if (result.isKnown) result.axis = kPlusY;
        double tidiest = 0.0;
        for (const auto& [f, stance] : stances) {
            const bool stands = stance.stands() && nearAxis(stance.up) == result.axis;
            if (result.axis != 0 && !stands) continue;
            double untidiness = stance.untidiness();
            if (result.isKnown)
                untidiness += glm::degrees(std::acos(std::clamp(stance.up.y, -1.0, 1.0)));
            if (result.bestStance && untidiness >= tidiest) continue;
            tidiest = untidiness;
            result.best = f;
            result.bestStance = stance;
        }
        return result;
    }

    /// The motion counted from a sample, the hips over the origin.
    Motion from(std::size_t frame, const Stance& stance) {
        measure(frame);
        const glm::dvec3 hips = stance.hips - glm::dot(stance.hips, up(stance)) * up(stance);
        return countedFrom(_motion, _world, _motion.rootPositions[frame] - hips);
    }

private:
    static glm::dvec3 up(const Stance& stance) {
        const int axis = nearAxis(stance.up);
        if (axis == 0) return stance.up;
        glm::dvec3 result(0.0);
        result[std::abs(axis) - 1] = axis > 0 ? 1.0 : -1.0;
        return result;
    }

    std::optional<Stance> measure(std::size_t frame) {
        worldRotations(_motion.skeleton, &_motion.rotation(frame, 0), _world);
        worldPositions(_motion.skeleton, _world, _motion.rootPositions[frame], _positions);
        return _joints.measure(_positions);
    }

    const Motion& _motion;
    const StanceJoints& _joints;
    std::vector<glm::dquat> _world;
    std::vector<glm::dvec3> _positions;
};

/// Roles of a motion's joints: its own, or else those of the rig's joints that they drive.
JointRoles rolesOf(const JointRoles& own, const JointRoles& rig,
                   const std::vector<int>& motionJoint) {
    if (own.known()) return own;
    JointRoles result = own;
    result.joints.clear();
    for (const auto& [role, joints] : rig.joints)
        for (const int j : joints) {
            const int driver = motionJoint[static_cast<std::size_t>(j)];
            if (driver >= 0) result.joints[role].push_back(driver);
        }
    return result;
}

/// "knees bent by 90 degrees, ..." - what keeps a pose from standing.
std::string faults(const std::optional<Stance>& stance) {
    if (!stance) return "bones without a length";
    const auto whole = [](double degrees) { return std::to_string(std::lround(degrees)); };
    return "knees bent by " + whole(stance->knees) + ", legs " + whole(2.0 * stance->spread) +
           " apart, trunk leaning by " + whole(stance->lean) + " degrees";
}

/// Where the skeletons are one, the rig's rest pose tells what the motion's rotations mean.
void countFromRig(const Motion& motion, const RestSkeleton& rig, const SameSkeleton& same,
                  const std::optional<Stance>& rest, const std::optional<Stance>& zero,
                  const Samples& samples, StandingPose& result) {
    const bool alike = std::all_of(same.toRigRest.begin(), same.toRigRest.end(),
                                   [](const glm::dquat& q) { return std::abs(q.w) > 1.0 - 1e-9; });
    if (!rest || !rest->stands()) {
        result.copied = same;
        result.notes.emplace_back("the rig is the motion's own skeleton and rests in no standing "
                                  "pose: local rotations are copied");
        return;
    }
    if (alike) return; // it stands as the rig does
    // Both files' spaces may have different axes up.
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    int axis = zero && zero->stands() ? nearAxis(zero->up) : samples.axis;
    if (motion.yIsUp && (samples.isKnown || axis == 0)) axis = kPlusY;
    const int rigAxis = nearAxis(rest->up);
    if (axis != 0 && rigAxis != 0 && axis != rigAxis) {
        glm::dvec3 from(0.0), to(0.0);
        from[std::abs(rigAxis) - 1] = rigAxis > 0 ? 1.0 : -1.0;
        to[std::abs(axis) - 1] = axis > 0 ? 1.0 : -1.0;
        turn = shortestRotation(from, to);
    }
    std::vector<glm::dquat> world = same.toRigRest;
    for (glm::dquat& q : world) q = glm::normalize(turn * q);
    int root = 0; // the rig's joint that the motion's root drives, or else its own root
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (rig.joints[j].name == motion.skeleton.joints[0].name) root = static_cast<int>(j);
    const glm::dvec3 place = turn * rig.joints[static_cast<std::size_t>(root)].centre / same.scale;
    result.counted = countedFrom(motion, world, place);
    result.notes.emplace_back("the rig is the motion's own skeleton: local rotations are copied");
}

} // namespace

StandingPose findStandingPose(const Motion& motion, const RestSkeleton& rig,
                              const std::vector<int>& motionJoint, const JointRoles& rigRoles,
                              const JointRoles& motionRoles) {
    StandingPose result;
    const StanceJoints joints(rolesOf(motionRoles, rigRoles, motionJoint));
    const StanceJoints rigJoints(rigRoles);
    const auto same = SameSkeleton::find(rig, motion.skeleton, motionJoint);
    if (!joints.complete()) return result; // nothing tells
    const std::optional<Stance> zero = joints.measure(centresOf(motion.skeleton));
    const bool zeroStands = zero && zero->stands();
    Sampler sampler(motion, joints);
    const Samples samples = sampler.look();

    if (rigJoints.complete()) {
        const std::optional<Stance> rest = rigJoints.measure(centresOf(rig));
        if (same) {
            countFromRig(motion, rig, *same, rest, zero, samples, result);
            return result;
        }
        if (!rest || !rest->stands())
            result.notes.push_back("the rig does not stand at rest (" + faults(rest) +
                                   "): its trunk and feet may point elsewhere than the actor's");
    }

    if (zeroStands) {
        const int own = nearAxis(zero->up);
        if (samples.axis == 0 && own != 0 && !samples.along.empty() &&
            samples.along.count(own) == 0)
            result.notes.emplace_back(kNeverAlong);
        if (samples.axis == 0 || own == 0 || samples.axis == own) return result;
        const auto countOf = [](const std::map<int, std::size_t>& counts, int axis) {
            const auto found = counts.find(axis);
            return found == counts.end() ? std::size_t(0) : found->second;
        };
        // Who lies on the floor stands across it, too. Who has the floor under the feet stands, and
        // who stands along +y does where files have it up.
        const std::size_t across = countOf(samples.standing, samples.axis);
        const bool isUp = samples.isKnown || samples.axis == kPlusY ||
                          10 * countOf(samples.grounded, samples.axis) >= 8 * across;
        const bool staysLying = !samples.isKnown && 10 * countOf(samples.standing, own) > across;
        if (!isUp || staysLying) {
            if (countOf(samples.standing, own) == 0) result.notes.emplace_back(kNeverAlong);
            return result;
        }
    }
    const std::string why = zeroStands
                                ? "the motion's zero pose lies"
                                : "the motion's zero pose does not stand (" + faults(zero) + ")";
    if (!samples.bestStance ||
        (samples.axis == 0 && samples.bestStance->untidiness() > kNearlyStands))
        throw Error("retarget: " + why + ", nor does any of its " + std::to_string(samples.all) +
                    " samples (the best has " + faults(samples.bestStance) +
                    "); expected one with straight legs and trunk, such as a T-pose, to tell "
                    "what its rotations mean");
    result.counted = sampler.from(samples.best, *samples.bestStance);
    result.notes.push_back(
        why + ": its rotations are counted from sample " + std::to_string(samples.best) +
        (samples.axis == 0 ? ", which nearly does" : ", in which the actor does"));
    return result;
}

} // namespace osgSkin
