// SPDX-License-Identifier: MIT
#include "retarget/Posture.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>
#include <osgSkinRig/Motion>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace osgSkin {
namespace {

/// The same motion with its rotations relative to another pose, which becomes its skeleton's zero
/// pose.
/// \param motion as it is
/// \param world rotations of its joints in that pose, from its zero pose, one for each
/// \param root position of the root joint there
Motion rebasedFrom(const Motion& motion, const std::vector<glm::dquat>& world,
                   const glm::dvec3& root) {
    Motion result = motion;
    std::vector<glm::dvec3> positions;
    worldPositions(motion.skeleton, world, root, positions);
    for (std::size_t j = 0; j < world.size(); ++j) {
        RestJoint& joint = result.skeleton.joints[j];
        if (joint.tip) joint.tip = positions[j] + world[j] * (*joint.tip - joint.centre);
        joint.centre = positions[j];
        joint.frame = glm::normalize(world[j] * joint.frame);
    }
    std::vector<glm::dquat> turned;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), turned);
        for (std::size_t j = 0; j < world.size(); ++j)
            turned[j] = glm::normalize(turned[j] * glm::conjugate(world[j]));
        for (std::size_t j = 0; j < world.size(); ++j) {
            const int parent = result.skeleton.joints[j].parent;
            result.rotations[f * world.size() + j] =
                parent < 0
                    ? turned[j]
                    : glm::normalize(glm::conjugate(turned[std::size_t(parent)]) * turned[j]);
        }
    }
    return result;
}

constexpr std::size_t kFewestBones = 5; ///< that must be equal for two skeletons to be the same
constexpr double kTolerance = 0.02; ///< sum of the bones' differences over the sum of their lengths

std::size_t at(int joint) {
    return static_cast<std::size_t>(joint);
}

/// The offset of a joint from its parent, in the parent's own frame.
glm::dvec3 offset(const RestSkeleton& skeleton, int joint) {
    const RestJoint& own = skeleton.joints[at(joint)];
    const RestJoint& parent = skeleton.joints[at(own.parent)];
    return glm::conjugate(parent.frame) * (own.centre - parent.centre);
}

} // namespace

std::optional<SameSkeleton> SameSkeleton::find(const RestSkeleton& rig, const RestSkeleton& motion,
                                               const std::vector<int>& motionJoint) {
    SameSkeleton result{1.0, std::vector<glm::dquat>(motion.joints.size(), {1.0, 0.0, 0.0, 0.0})};
    std::vector<int> rigJoint(motion.joints.size(), -1);
    std::vector<glm::dvec3> ours, theirs;
    double ourLength = 0.0, theirLength = 0.0;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int driver = motionJoint[j];
        if (driver < 0) continue;
        if (rig.joints[j].name != motion.joints[at(driver)].name) return std::nullopt;
        rigJoint[at(driver)] = static_cast<int>(j);
        const int parent = rig.joints[j].parent;
        if (parent < 0 || motionJoint[at(parent)] < 0) continue;
        if (motion.joints[at(driver)].parent != motionJoint[at(parent)]) return std::nullopt;
        ours.push_back(offset(rig, static_cast<int>(j)));
        theirs.push_back(offset(motion, driver));
        ourLength += glm::length(ours.back());
        theirLength += glm::length(theirs.back());
    }
    if (ours.size() < kFewestBones || !(theirLength > 0.0)) return std::nullopt;
    result.scale = ourLength / theirLength;
    double difference = 0.0;
    for (std::size_t b = 0; b < ours.size(); ++b)
        difference += glm::distance(ours[b], result.scale * theirs[b]);
    if (!(difference <= kTolerance * ourLength)) return std::nullopt;

    for (std::size_t m = 0; m < motion.joints.size(); ++m) {
        const int j = rigJoint[m], parent = motion.joints[m].parent;
        if (j >= 0)
            result.toRigRest[m] =
                glm::normalize(rig.joints[at(j)].frame * glm::conjugate(motion.joints[m].frame));
        else if (parent >= 0)
            result.toRigRest[m] = result.toRigRest[at(parent)];
    }
    return result;
}

Clip copyRotations(const Motion& motion, const RestSkeleton& rig,
                   const std::vector<int>& motionJoint, const SameSkeleton& same,
                   glm::dvec3& offset) {
    std::size_t first = 0; // the joint that the root motion moves
    while (motionJoint[first] < 0) ++first;
    const auto driver = static_cast<std::size_t>(motionJoint[first]);
    offset = rig.joints[first].centre - same.scale * motion.skeleton.joints[driver].centre;

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    std::vector<glm::dquat> motionWorld, world(clip.joints);
    std::vector<glm::dvec3> motionPositions, positions;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        for (std::size_t j = 0; j < clip.joints; ++j) {
            const int parent = rig.joints[j].parent;
            const glm::dquat above = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                                : world[static_cast<std::size_t>(parent)];
            world[j] = above;
            if (motionJoint[j] >= 0) {
                const auto m = static_cast<std::size_t>(motionJoint[j]);
                world[j] = glm::normalize(motionWorld[m] * glm::conjugate(same.toRigRest[m]));
            }
            clip.rotations.push_back(glm::normalize(glm::conjugate(above) * world[j]));
        }
        worldPositions(motion.skeleton, motionWorld, motion.rootPositions[f], motionPositions);
        worldPositions(rig, world, glm::dvec3(0.0), positions);
        clip.rootPositions.push_back(same.scale * motionPositions[driver] + offset -
                                     positions[first]);
    }
    return clip;
}

namespace {

/// Number of samples that are measured in long motions.
constexpr std::size_t kMaxSamples = 4000;

/// Largest untidiness() of a pose that nearly stands, where no sample stands.
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

/// The actor's posture over a motion's samples.
struct Samples {
    std::map<int, std::size_t> standing; ///< axis -> samples that stand along it
    std::map<int, std::size_t> grounded; ///< of them, with the feet on a floor through the origin
    std::map<int, std::size_t> along;    ///< axis -> samples with the legs along it, however bent
    std::size_t all = 0;

    int axis = 0; ///< along which most samples stand; +y where that is known to be up and some do
    bool isKnown = false; ///< whether +y is known to be up

    /// The sample along `axis` that is nearest to a calibration pose, or of all samples where none
    /// stands.
    std::size_t best = 0;
    std::optional<Stance> bestStance;
};

class Sampler {
public:
    Sampler(const Motion& motion, const StanceJoints& joints) : _motion(motion), _joints(joints) {}

    Samples look() {
        Samples result;
        const std::size_t step = std::max<std::size_t>(1, _motion.frames / kMaxSamples);
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

    /// The motion relative to a sample, with the hips above the origin.
    Motion from(std::size_t frame, const Stance& stance) {
        measure(frame);
        const glm::dvec3 hips = stance.hips - glm::dot(stance.hips, up(stance)) * up(stance);
        return rebasedFrom(_motion, _world, _motion.rootPositions[frame] - hips);
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

/// Why a pose does not stand: "knees bent by 90 degrees, ...".
std::string faults(const std::optional<Stance>& stance) {
    if (!stance) return "bones without a length";
    const auto whole = [](double degrees) { return std::to_string(std::lround(degrees)); };
    return "knees bent by " + whole(stance->knees) + ", legs " + whole(2.0 * stance->spread) +
           " apart, trunk leaning by " + whole(stance->lean) + " degrees";
}

/// Where the skeletons are the same, the motion's rotations are made relative to the rig's rest
/// pose.
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
    if (alike) return; // the zero pose is the rig's rest pose
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
    result.counted = rebasedFrom(motion, world, place);
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
    if (!joints.complete()) return result; // unknown roles
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
        // A lying actor also looks upright about another axis: accept an axis only if the feet are
        // on the floor, or if it is +y, which files usually have as up.
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
