// SPDX-License-Identifier: MIT
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"
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
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace osgSkin {

RestSkeleton ZeroPose::applyTo(const RestSkeleton& skeleton) const {
    RestSkeleton result = skeleton;
    std::vector<glm::dvec3> positions;
    worldPositions(skeleton, world, root, positions);
    for (std::size_t j = 0; j < world.size(); ++j) {
        RestJoint& joint = result.joints[j];
        if (joint.tip) joint.tip = positions[j] + world[j] * (*joint.tip - joint.centre);
        joint.centre = positions[j];
        joint.frame = glm::normalize(world[j] * joint.frame);
    }
    return result;
}

namespace {

constexpr std::size_t kMinBones = 5; ///< that must agree for two skeletons to be the same
constexpr double kTolerance = 0.02; ///< sum of the bones' differences over the sum of their lengths
constexpr double kLongBone = 0.2;   ///< over the longest; fingers differ from hand to hand
const double kSameDirection = std::cos(glm::radians(25.0));

std::size_t at(int joint) {
    return static_cast<std::size_t>(joint);
}

/// The offset of a joint from one above it, in that one's own frame.
glm::dvec3 offset(const RestSkeleton& skeleton, int joint, int from) {
    const RestJoint& above = skeleton.joints[at(from)];
    return glm::conjugate(above.frame) * (skeleton.joints[at(joint)].centre - above.centre);
}

/// For each joint the nearest one above it for which `chosen` has an index; -1 for none.
std::vector<int> nearestAbove(const RestSkeleton& skeleton, const std::vector<int>& chosen) {
    std::vector<int> result;
    for (const RestJoint& joint : skeleton.joints) {
        const bool isNext = joint.parent < 0 || chosen[at(joint.parent)] >= 0;
        result.push_back(isNext ? joint.parent : result[at(joint.parent)]);
    }
    return result;
}

double longest(const std::vector<glm::dvec3>& bones) {
    double result = 0.0;
    for (const glm::dvec3& bone : bones) result = std::max(result, glm::length(bone));
    return result;
}

/// Whether bones have the same directions, whatever their lengths. Short ones do not count.
bool doDirectionsAgree(const std::vector<glm::dvec3>& ours, const std::vector<glm::dvec3>& theirs) {
    const double ourLongest = longest(ours), theirLongest = longest(theirs);
    std::size_t agree = 0;
    for (std::size_t b = 0; b < ours.size(); ++b) {
        const double a = glm::length(ours[b]), c = glm::length(theirs[b]);
        if (a < kLongBone * ourLongest || c < kLongBone * theirLongest) continue;
        if (!(glm::dot(ours[b], theirs[b]) >= kSameDirection * a * c)) return false;
        ++agree;
    }
    return agree >= kMinBones;
}

} // namespace

std::optional<SameSkeleton> SameSkeleton::find(const RestSkeleton& rig, const RestSkeleton& motion,
                                               const std::vector<int>& motionJoint) {
    SameSkeleton result{1.0, false, false,
                        std::vector<glm::dquat>(motion.joints.size(), {1.0, 0.0, 0.0, 0.0})};
    std::vector<int> rigJoint(motion.joints.size(), -1);
    std::vector<glm::dvec3> ours, theirs;
    double ourLength = 0.0, theirLength = 0.0;
    const std::size_t ourPrefix = sharedPrefix(rig), theirPrefix = sharedPrefix(motion);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int driver = motionJoint[j];
        if (driver < 0) continue;
        const std::string &our = rig.joints[j].name, &their = motion.joints[at(driver)].name;
        if (our != their && our.substr(ourPrefix) != their.substr(theirPrefix)) return std::nullopt;
        rigJoint[at(driver)] = static_cast<int>(j);
    }
    const std::vector<int> ourNearest = nearestAbove(rig, motionJoint); // either may have more
    const std::vector<int> theirNearest = nearestAbove(motion, rigJoint);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int driver = motionJoint[j], from = ourNearest[j];
        if (driver < 0 || from < 0) continue;
        const int above = motionJoint[at(from)];
        if (theirNearest[at(driver)] != above) return std::nullopt;
        ours.push_back(offset(rig, static_cast<int>(j), from));
        theirs.push_back(offset(motion, driver, above));
        ourLength += glm::length(ours.back());
        theirLength += glm::length(theirs.back());
    }
    if (!(ourLength > 0.0 && theirLength > 0.0) || !doDirectionsAgree(ours, theirs))
        return std::nullopt;
    result.scale = ourLength / theirLength;

    for (std::size_t m = 0; m < motion.joints.size(); ++m) {
        const int j = rigJoint[m], parent = motion.joints[m].parent;
        if (j >= 0)
            result.toRigRest[m] =
                glm::normalize(rig.joints[at(j)].frame * glm::conjugate(motion.joints[m].frame));
        else if (parent >= 0)
            result.toRigRest[m] = result.toRigRest[at(parent)];
    }
    result.restsAlike = std::all_of(result.toRigRest.begin(), result.toRigRest.end(),
                                    [](const glm::dquat& q) { return std::abs(q.w) > 1.0 - 1e-9; });
    double difference = 0.0;
    for (std::size_t b = 0; b < ours.size(); ++b)
        difference += glm::distance(ours[b], result.scale * theirs[b]);
    result.isSameBody = difference <= kTolerance * ourLength;
    // Bodies that differ at rest, in the same axes, are to be aligned.
    if (result.restsAlike && !result.isSameBody) return std::nullopt;
    return result;
}

RotationCopy::RotationCopy(const RestSkeleton& motion, const RestSkeleton& rig,
                           const std::vector<int>& motionJoint, const SameSkeleton& same)
    : _motion(motion), _rig(rig), _motionJoint(motionJoint), _same(same) {
    while (motionJoint[_first] < 0) ++_first;
    _offset = rig.joints[_first].centre - same.scale * motion.joints[driver()].centre;
}

glm::dvec3 RotationCopy::pose(const glm::dquat* local, const glm::dvec3& root,
                              glm::dquat* rotations) {
    worldRotations(_motion, local, _motionWorld);
    _world.resize(_rig.joints.size());
    for (std::size_t j = 0; j < _world.size(); ++j) {
        const int parent = _rig.joints[j].parent;
        const glm::dquat above = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0) : _world[at(parent)];
        _world[j] = above;
        if (_motionJoint[j] >= 0) {
            const std::size_t m = at(_motionJoint[j]);
            _world[j] = glm::normalize(_motionWorld[m] * glm::conjugate(_same.toRigRest[m]));
        }
        rotations[j] = glm::normalize(glm::conjugate(above) * _world[j]);
    }
    worldPositions(_motion, _motionWorld, root, _motionPositions);
    worldPositions(_rig, _world, glm::dvec3(0.0), _positions);
    return _same.scale * _motionPositions[driver()] + _offset - _positions[_first];
}

namespace {

/// Number of samples that are measured in long motions.
constexpr std::size_t kMaxSamples = 4000;

/// Largest untidiness() of a pose that nearly stands, where no sample stands.
constexpr double kNearlyStands = 5.0;

constexpr int kPlusY = 2, kPlusZ = 3; ///< as nearAxis() has them

constexpr const char* kNeverAlong =
    "the actor's legs are never along the axis of the motion's zero pose: he lies, or the zero "
    "pose does";

/// One sample of a motion.
struct Sample {
    std::size_t frame;
    Posture posture;
    int axis;             ///< along which the legs are, as nearAxis() has it
    glm::dvec3 low, high; ///< the box of all joints

    /// Whether the body is straight along an axis: the actor stands, or lies.
    bool isStraight() const { return axis != 0 && posture.stands(); }

    /// Height of the lowest joint along an axis.
    double lowest(int up) const { return up > 0 ? low[up - 1] : -high[-up - 1]; }

    /// Whether the feet are on a floor through the origin, if the actor stands.
    bool hasFeetOnFloor() const {
        const double height = glm::dot(posture.hips, posture.up) / posture.leg;
        return height > 0.5 && height < 1.7 && std::abs(posture.lowest) < 0.4 * posture.leg;
    }

    /// Whether the body lies on the floor through the origin, across an axis.
    bool liesOnFloor(int up) const {
        const double height = glm::dot(posture.hips, alongAxis(up)) / posture.leg;
        return lowest(up) > -0.03 * posture.leg && height > 0.05 && height < 0.4;
    }
};

/// The actor's posture over a motion's samples.
struct Samples {
    std::vector<Sample> list; ///< those in which both legs have a direction
    std::size_t all = 0;

    /// The number of samples in which the body is straight along an axis, and `also` holds.
    template <typename Also>
    std::size_t straight(int axis, const Also& also) const {
        return static_cast<std::size_t>(
            std::count_if(list.begin(), list.end(), [&](const Sample& sample) {
                return sample.isStraight() && sample.axis == axis && also(sample);
            }));
    }

    std::size_t straight(int axis) const {
        return straight(axis, [](const Sample&) { return true; });
    }

    bool haveLegsAlong(int axis) const {
        return std::any_of(list.begin(), list.end(), [&](const auto& s) { return s.axis == axis; });
    }

    /// The axis along which most of the samples are that `counts` accepts; 0 for none.
    template <typename Counts>
    int mostAxis(const Counts& counts) const {
        std::map<int, std::size_t> along;
        for (const Sample& sample : list)
            if (sample.axis != 0 && counts(sample)) ++along[sample.axis];
        int result = 0;
        std::size_t most = 0;
        for (const auto& [axis, count] : along)
            if (count > most) {
                most = count;
                result = axis;
            }
        return result;
    }

    /// The axis along which the body is straight in most samples; 0 where it never is.
    int straightAxis() const {
        return mostAxis([](const Sample& sample) { return sample.isStraight(); });
    }

    /// The axis along which the legs are in most samples, however bent; 0 for none.
    int legsAxis() const {
        return mostAxis([](const Sample&) { return true; });
    }

    /// The sample that is nearest to a calibration pose: of those that stand along `up`, or else
    /// that are straight, or else of all. Null where there is none.
    /// \param isKnown whether `up` is known for sure, so that a pose across it is none
    const Sample* best(int up, bool isKnown) const {
        const bool stand = straight(up) > 0, anyStraight = straightAxis() != 0;
        const bool alsoLie = std::any_of(list.begin(), list.end(), [&](const Sample& sample) {
            return sample.isStraight() && sample.axis != up;
        });
        const Sample* result = nullptr;
        double tidiest = 0.0;
        for (const Sample& sample : list) {
            if (stand ? !sample.isStraight() || sample.axis != up
                      : anyStraight && !sample.isStraight())
                continue;
            double untidiness = sample.posture.untidiness();
            if (stand && (isKnown || alsoLie)) {
                const double cosine = glm::dot(sample.posture.up, alongAxis(up));
                untidiness += glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
            }
            if (result != nullptr && untidiness >= tidiest) continue;
            tidiest = untidiness;
            result = &sample;
        }
        return result;
    }

    /// How much the height of the lowest joint changes, in leg lengths: little along the axis that
    /// is up, unless the actor jumps or climbs.
    double floorRange(int up) const {
        std::vector<double> heights;
        for (const Sample& sample : list) heights.push_back(sample.lowest(up) / sample.posture.leg);
        std::sort(heights.begin(), heights.end());
        return heights[heights.size() - 1 - heights.size() / 20] - heights[heights.size() / 20];
    }

    /// Whether the actor moves over a floor across `axis`, and over none across `other`.
    bool moveOverFloor(int axis, int other) const {
        return floorRange(axis) < 0.2 && floorRange(other) > 0.5;
    }

    /// Whether an axis along which the body is straight is up: the actor has the feet on the floor,
    /// or moves over it. Otherwise he may lie.
    bool standOnFloor(int axis) const {
        const std::size_t onFeet =
            straight(axis, [](const Sample& sample) { return sample.hasFeetOnFloor(); });
        if (onFeet > 0 && 10 * onFeet >= 8 * straight(axis) && !lieOnFloor(axis, kPlusY))
            return true;
        return axis != kPlusY && moveOverFloor(axis, kPlusY);
    }

    /// Whether the body is on the floor across `up` in most samples in which it is straight along
    /// `axis`.
    bool lieOnFloor(int axis, int up) const {
        const std::size_t lying =
            straight(axis, [&](const Sample& sample) { return sample.liesOnFloor(up); });
        return axis != up && lying > 0 && 2 * lying >= straight(axis);
    }
};

class Sampler {
public:
    Sampler(const Motion& motion, const PostureJoints& joints) : _motion(motion), _joints(joints) {}

    Samples measure() {
        Samples result;
        const std::size_t step = std::max<std::size_t>(1, _motion.frames / kMaxSamples);
        for (std::size_t f = 0; f < _motion.frames; f += step) {
            ++result.all;
            pose(f);
            const auto posture = _joints.measure(_positions);
            if (!posture) continue;
            Sample sample{f, *posture, nearAxis(posture->up), _positions[0], _positions[0]};
            for (const glm::dvec3& position : _positions) {
                sample.low = glm::min(sample.low, position);
                sample.high = glm::max(sample.high, position);
            }
            result.list.push_back(sample);
        }
        return result;
    }

    /// A sample's pose, rotated upright if the actor lies in it, and to the front.
    /// \param up axis, 0 if unknown
    ZeroPose fromSample(const Sample& sample, int up) {
        pose(sample.frame);
        const int to = sample.axis == 0 ? 0 : up;
        const glm::dvec3& root = _motion.rootPositions[sample.frame];
        return facingFront(from(sample.posture, to, root), sample, to != 0 ? to : sample.axis);
    }

    /// The zero pose, rotated upright, with the trunk over the legs.
    /// \param zero its posture
    /// \param roles of the motion's joints
    /// \param up axis, 0 if unknown
    ZeroPose fromZero(const Posture& zero, const JointRoles& roles, int up) {
        const RestSkeleton& skeleton = _motion.skeleton;
        const int legs[] = {roles.joints.at("LeftUpperLeg").front(),
                            roles.joints.at("RightUpperLeg").front()};
        const auto isOfLegs = [&](int j) {
            return std::any_of(std::begin(legs), std::end(legs), [&](int leg) {
                return skeleton.isInSubtree(j, leg) || skeleton.isInSubtree(leg, j);
            });
        };
        int waist = _joints.top(); // where the trunk begins to lean
        while (waist > 0 && !isOfLegs(skeleton.joints[at(waist)].parent))
            waist = skeleton.joints[at(waist)].parent;
        glm::dvec3 trunk = zero.hips + zero.trunk - skeleton.joints[at(waist)].centre;
        if (!(glm::length(trunk) > 0.0)) trunk = zero.trunk;
        const glm::dquat unbent = shortestRotation(trunk, zero.up);
        _world.clear();
        for (int j = 0; j < static_cast<int>(skeleton.joints.size()); ++j)
            _world.push_back(isOfLegs(j) ? glm::dquat(1.0, 0.0, 0.0, 0.0) : unbent);
        return from(zero, up, skeleton.joints[0].centre);
    }

private:
    /// The pose in `_world`, with the hips above the origin.
    ZeroPose from(const Posture& posture, int up, glm::dvec3 root) {
        const int own = nearAxis(posture.up);
        glm::dvec3 axis = own == 0 ? posture.up : alongAxis(own), hips = posture.hips;
        if (up != 0 && up != own) {
            const glm::dquat turn = shortestRotation(axis, alongAxis(up));
            for (glm::dquat& q : _world) q = glm::normalize(turn * q);
            axis = alongAxis(up);
            hips = turn * hips;
            root = turn * root;
        }
        return {_world, root - (hips - glm::dot(hips, axis) * axis)};
    }

    /// A sample's pose from from(), turned about the axis `up` so that left is +x.
    ZeroPose facingFront(ZeroPose pose, const Sample& sample, int up) {
        if (up != kPlusY && up != kPlusZ) return pose;
        glm::dvec3 left = sample.posture.left;
        if (up != sample.axis)
            left = shortestRotation(alongAxis(sample.axis), alongAxis(up)) * left;
        const double back = up == kPlusY ? -left.z : left.y; // behind the right side
        const glm::dquat turn = glm::angleAxis(-std::atan2(back, left.x), alongAxis(up));
        for (glm::dquat& q : pose.world) q = glm::normalize(turn * q);
        pose.root = turn * pose.root;
        return pose;
    }

    void pose(std::size_t frame) {
        worldRotations(_motion.skeleton, &_motion.rotation(frame, 0), _world);
        worldPositions(_motion.skeleton, _world, _motion.rootPositions[frame], _positions);
    }

    const Motion& _motion;
    const PostureJoints& _joints;
    std::vector<glm::dquat> _world;
    std::vector<glm::dvec3> _positions;
};

/// Why a pose does not stand: "knees bent by 90 degrees, ...".
std::string faults(const std::optional<Posture>& posture) {
    if (!posture) return "bones without a length";
    const auto whole = [](double degrees) { return std::to_string(std::lround(degrees)); };
    return "knees bent by " + whole(posture->knees) + ", legs " + whole(2.0 * posture->spread) +
           " apart, trunk leaning by " + whole(posture->lean) + " degrees";
}

/// The axis that is up in the motion's space, as nearAxis() has it; 0 if it is unknown.
///
/// The caller's word goes first, then the file's, unless the actor stands on a floor across another
/// axis. A lying actor is straight along an axis, too: without such a floor, the zero pose's legs
/// tell, if they are straight and he does not lie on the floor y = 0, or +y is up if he ever stands
/// along it.
int upOf(const Motion& motion, RetargetOptions::Up stated, const std::optional<Posture>& zero,
         const Samples& samples) {
    if (stated != RetargetOptions::Up::Unknown)
        return stated == RetargetOptions::Up::Y ? kPlusY : kPlusZ;
    const int straight = samples.straightAxis();
    const int most = straight != 0 ? straight : samples.legsAxis();
    const bool stands = most != 0 && samples.standOnFloor(most);
    if (motion.yIsUp) return samples.straight(kPlusY) == 0 && stands ? most : kPlusY;
    const int own = zero && zero->standsLeaning() ? nearAxis(zero->up) : 0;
    if (own != 0) {
        if (straight == 0) return own;
        if (straight == own || 10 * samples.straight(own) > samples.straight(straight))
            return !samples.standOnFloor(own) && samples.lieOnFloor(own, kPlusY) ? kPlusY : own;
        if (stands) return straight;
        return straight == kPlusY && !samples.lieOnFloor(kPlusY, own) ? kPlusY : own;
    }
    if (zero && zero->stands()) return 0;
    if (stands || most == 0) return most;
    const bool isOnY = 10 * samples.straight(kPlusY) > samples.straight(most) ||
                       samples.lieOnFloor(most, kPlusY) || samples.moveOverFloor(kPlusY, most);
    return isOnY ? kPlusY : most;
}

/// Where the skeletons are the same, the motion's rotations are made relative to the rig's rest
/// pose.
/// \param isStated whether the caller says which axis is up
void countFromRig(const RestSkeleton& rig, const RestSkeleton& motion,
                  const std::vector<int>& motionJoint, const SameSkeleton& same,
                  const std::optional<Posture>& rest, const std::optional<Posture>& zero, int up,
                  bool isStated, StandingPose& result) {
    if (!rest || !rest->stands()) {
        result.copied = same;
        result.notes.emplace_back("the rig has the motion's joints and rests in no standing pose: "
                                  "local rotations are copied");
        return;
    }
    // Both files' spaces may have different axes up.
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    const int rigAxis = nearAxis(rest->up);
    const bool standAlike = zero && zero->stands() && nearAxis(zero->up) == rigAxis;
    if (up != 0 && rigAxis != 0 && up != rigAxis && (isStated || !standAlike))
        turn = shortestRotation(alongAxis(rigAxis), alongAxis(up));
    if (same.restsAlike && isIdentity(turn)) return; // the zero pose is the rig's rest pose
    std::vector<glm::dquat> world = same.toRigRest;
    for (glm::dquat& q : world) q = glm::normalize(turn * q);
    std::size_t first = 0; // that is driven
    while (motionJoint[first] < 0) ++first;
    std::vector<glm::dvec3> fromRoot;
    worldPositions(motion, world, glm::dvec3(0.0), fromRoot);
    const glm::dvec3 place =
        turn * rig.joints[first].centre / same.scale - fromRoot[at(motionJoint[first])];
    result.counted = ZeroPose{std::move(world), place};
    result.notes.emplace_back("the rig has the motion's joints: local rotations are copied");
}

} // namespace

StandingPose findStandingPose(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
                              RetargetOptions::Up stated) {
    StandingPose result;
    const JointRoles roles = motionRolesOf(map);
    const PostureJoints joints(roles);
    const PostureJoints rigJoints(map.rig);
    const auto same = SameSkeleton::find(rig, motion.skeleton, map.motionJoint);
    result.isSame = same.has_value();
    if (same && same->isSameBody) result.bodyScale = same->scale;
    const bool isKnown = joints.complete();
    if (!isKnown && !(same && rigJoints.complete())) return result;
    const std::optional<Posture> zero =
        isKnown ? joints.measure(centresOf(motion.skeleton)) : std::nullopt;
    const bool zeroStands = zero && zero->stands();
    Sampler sampler(motion, joints);
    const Samples samples = isKnown ? sampler.measure() : Samples();
    const int up = upOf(motion, stated, zero, samples);
    const bool isStated = stated != RetargetOptions::Up::Unknown;

    if (rigJoints.complete()) {
        const std::optional<Posture> rest = rigJoints.measure(centresOf(rig));
        if (same) {
            countFromRig(rig, motion.skeleton, map.motionJoint, *same, rest, zero, up, isStated,
                         result);
            return result;
        }
        if (!rest || !rest->stands())
            result.notes.push_back("the rig does not stand at rest (" + faults(rest) +
                                   "): its trunk and feet may point elsewhere than the actor's");
    }

    if (same && !zeroStands) {
        result.copied = same;
        result.notes.emplace_back("the rig has the motion's joints: local rotations are copied");
        return result;
    }
    if (zeroStands && (up == 0 || up == nearAxis(zero->up))) {
        const bool isAlong =
            samples.straightAxis() != 0 ? samples.straight(up) > 0 : samples.haveLegsAlong(up);
        if (up != 0 && samples.legsAxis() != 0 && !isAlong) result.notes.emplace_back(kNeverAlong);
        return result;
    }
    const std::string why = zeroStands
                                ? "the motion's zero pose lies"
                                : "the motion's zero pose does not stand (" + faults(zero) + ")";
    const Sample* best = samples.best(up, isStated || motion.yIsUp);
    const bool isStraight = best != nullptr && best->isStraight();
    if (!isStraight && zero && zero->standsLeaning()) {
        result.counted = sampler.fromZero(*zero, roles, up);
        result.notes.push_back(why + ", nor does any sample: its rotations are counted from that "
                                     "pose, straightened");
        return result;
    }
    const bool nearlyStands = best != nullptr && (best->axis != 0 || best->posture.stands()) &&
                              best->posture.untidiness() <= kNearlyStands;
    if (!isStraight && !nearlyStands)
        throw Error("retarget: " + why + ", nor does any of its " + std::to_string(samples.all) +
                    " samples (the best has " +
                    faults(best == nullptr ? std::nullopt : std::optional(best->posture)) +
                    "); expected one with straight legs and trunk, such as a T-pose, to tell "
                    "what its rotations mean");
    result.counted = sampler.fromSample(*best, up);
    const char* how = !isStraight                   ? ", which nearly does"
                      : up != 0 && best->axis != up ? ", in which the actor lies"
                                                    : ", in which the actor does";
    result.notes.push_back(why + ": its rotations are counted from sample " +
                           std::to_string(best->frame) + how);
    return result;
}

} // namespace osgSkin
