// SPDX-License-Identifier: MIT
#include "retarget/RetargetTarget.h"

#include "names/NameWords.h"
#include "names/Sides.h"
#include "retarget/Posture.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/BodyDirections>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

std::size_t sharedPrefix(const RestSkeleton& skeleton) {
    const std::string& first = skeleton.joints.front().name;
    std::size_t length = first.size();
    for (const RestJoint& joint : skeleton.joints) {
        const auto end = first.begin() + static_cast<std::ptrdiff_t>(length);
        const auto differs =
            std::mismatch(first.begin(), end, joint.name.begin(), joint.name.end()).first;
        length = static_cast<std::size_t>(differs - first.begin());
    }
    return length;
}

namespace {

using ByName = std::map<std::string, int>;

void checkNames(const RestSkeleton& rig, const ByName& motion,
                const std::map<std::string, std::string>& names) {
    const ByName rigJoints = rig.byName();
    for (const auto& [rigName, motionName] : names) {
        if (rigJoints.count(rigName) == 0)
            throw Error("retarget: the map names the joint \"" + rigName +
                        "\", which the rig does not have" + expectedNames(rigName, rigJoints));
        if (!motionName.empty() && motion.count(motionName) == 0)
            throw Error("retarget: the map gives \"" + rigName + "\" the joint \"" + motionName +
                        "\", which the motion does not have" + expectedNames(motionName, motion));
    }
}

/// The motion's joints, also by the names that they would have with the rig's prefix.
ByName findNamesakes(const RestSkeleton& rig, const RestSkeleton& motion) {
    const ByName own = motion.byName();
    ByName result = own;
    if (motion.joints.size() < 2) return result;
    const std::string prefix = rig.joints.front().name.substr(0, sharedPrefix(rig));
    const std::size_t length = sharedPrefix(motion);
    for (const auto& [name, joint] : own) result.emplace(prefix + name.substr(length), joint);
    return result;
}

/// Roles that stand in for a missing one: some hands have all fingers in one joint.
std::vector<std::string> substitutes(const std::string& role) {
    for (const std::string side : {"Left", "Right"})
        if (role == side + "Fingers") return {side + "Middle1", side + "Index1"};
    return {};
}

/// The motion joint that has the role of rig joint `j`.
int byRole(const JointPairs& map, std::size_t j) {
    const std::string& role = map.rig.roles[j];
    if (role.empty() || !map.motion.known()) return -1;
    auto found = map.motion.joints.find(role);
    for (const std::string& other : substitutes(role))
        if (found == map.motion.joints.end()) found = map.motion.joints.find(other);
    if (found == map.motion.joints.end()) return -1;
    const std::vector<int>& theirs = found->second;
    const std::vector<int>& ours = map.rig.joints.at(role);
    const auto index = static_cast<std::size_t>(
        std::find(ours.begin(), ours.end(), static_cast<int>(j)) - ours.begin());
    if (ours.size() == 1) return theirs.back();
    const double fraction = static_cast<double>(index) / static_cast<double>(ours.size() - 1);
    return theirs[static_cast<std::size_t>(
        std::lround(fraction * static_cast<double>(theirs.size() - 1)))];
}

struct Namesakes {
    std::vector<int> motionJoint; ///< [rig joint], -1 for none
    bool areOfOneBody;            ///< whether the skeletons are the same but for further joints
};

/// The motion's joints that have names of the rig's, where all of these are below each other in the
/// same way. Joints of one body may have others between them, but where one continues the joint
/// above it, as a second one of the neck, and the skeletons rest alike, roles serve better.
std::optional<Namesakes> fittingNamesakes(const JointPairs& map, const RestSkeleton& rig,
                                          const RestSkeleton& motion, const ByName& motionJoints) {
    Namesakes result{std::vector<int>(rig.joints.size(), -1), false};
    bool isBetween = false, isOnlyTheirs = true, continues = false;
    const auto role = [&](int m) { return map.motion.roles[static_cast<std::size_t>(m)]; };
    std::vector<int> nearest; // the namesake of a rig's joint or of the next one above that has one
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int parent = rig.joints[j].parent;
        const int above = parent < 0 ? -1 : nearest[static_cast<std::size_t>(parent)];
        const auto found = motionJoints.find(rig.joints[j].name);
        nearest.push_back(found == motionJoints.end() ? above : found->second);
        if (found == motionJoints.end()) continue;
        const int own = result.motionJoint[j] = found->second;
        if (above < 0) continue;
        isOnlyTheirs = isOnlyTheirs && result.motionJoint[static_cast<std::size_t>(parent)] >= 0;
        const int next = motion.joints[static_cast<std::size_t>(own)].parent;
        if (next == above) continue;
        if (next < 0) return std::nullopt;
        isBetween = true;
        continues = continues ||
                    (!role(next).empty() && role(next) == role(above) && role(next) != role(own));
    }
    const auto same = SameSkeleton::find(rig, motion, result.motionJoint);
    result.areOfOneBody = same && same->isSameBody && !(continues && same->restsAlike);
    if (isBetween && !(isOnlyTheirs && result.areOfOneBody)) return std::nullopt;
    return result;
}

/// Gives a motion's joints the roles of the rig's joints that have their names: one more joint in
/// the motion may have led to other roles.
void shareRoles(JointPairs& map, const std::vector<int>& namesakes) {
    JointRoles shared;
    shared.family = map.motion.known() ? map.motion.family : map.rig.family;
    shared.roles.resize(map.motion.roles.size());
    shared.parts.resize(map.motion.parts.size());
    std::vector<bool> isNamesake(shared.roles.size(), false);
    for (std::size_t j = 0; j < namesakes.size(); ++j) {
        if (namesakes[j] < 0) continue;
        const auto m = static_cast<std::size_t>(namesakes[j]);
        isNamesake[m] = true;
        shared.roles[m] = map.rig.roles[j];
        shared.parts[m] = map.rig.parts[j];
        if (!shared.roles[m].empty()) shared.joints[shared.roles[m]].push_back(namesakes[j]);
    }
    const auto ofNamesakes = shared.joints;
    if (ofNamesakes.empty()) return;
    for (std::size_t m = 0; m < isNamesake.size(); ++m) { // the others keep roles that are left
        const std::string& role = map.motion.roles[m];
        if (isNamesake[m] || role.empty() || ofNamesakes.count(role) != 0) continue;
        shared.roles[m] = role;
        shared.parts[m] = map.motion.parts[m];
        shared.joints[role].push_back(static_cast<int>(m));
    }
    map.motion = std::move(shared);
}

/// The motion joint of the same name, unless it is another part of the body.
int byName(const JointPairs& map, const ByName& motion, const std::string& name, std::size_t j) {
    const auto found = motion.find(name);
    if (found == motion.end()) return -1;
    const std::string& theirs = map.motion.roles[static_cast<std::size_t>(found->second)];
    const std::string& ours = map.rig.roles[j];
    const bool differs = map.rig.known() && map.motion.known() && theirs != ours;
    return differs ? -1 : found->second;
}

/// Whether the two skeletons call a joint alike that is on the left of one and on the right of the
/// other.
bool isOneNameOnBothSides(const JointPairs& map, const RestSkeleton& rig,
                          const RestSkeleton& motion) {
    const int left = map.rig.joint("LeftUpperLeg"), right = map.motion.joint("RightUpperLeg");
    return left >= 0 && right >= 0 &&
           rig.joints[static_cast<std::size_t>(left)].name ==
               motion.joints[static_cast<std::size_t>(right)].name;
}

} // namespace

JointPairs mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                     const RetargetOptions& options) {
    const ByName motionJoints = motion.byName();
    checkNames(rig, motionJoints, options.joints);
    JointPairs map;
    map.rig = recogniseJoints(rig, options.names);
    map.motion = recogniseJoints(motion, options.names);
    if (isOneNameOnBothSides(map, rig, motion)) exchangeSides(map.motion);
    const ByName namesakes = findNamesakes(rig, motion);
    std::vector<int> ofOneBody(rig.joints.size(), -1);
    std::vector<bool> isTaken(motion.joints.size(), false);
    if (map.rig.known())
        if (const auto fitting = fittingNamesakes(map, rig, motion, namesakes)) {
            shareRoles(map, fitting->motionJoint);
            if (fitting->areOfOneBody) ofOneBody = fitting->motionJoint;
        }
    for (const int m : ofOneBody)
        if (m >= 0) isTaken[static_cast<std::size_t>(m)] = true;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const std::string& name = rig.joints[j].name;
        const auto named = options.joints.find(name);
        if (named != options.joints.end()) {
            map.motionJoint.push_back(named->second.empty() ? -1 : motionJoints.at(named->second));
            continue;
        }
        int found = byRole(map, j);
        if (found < 0) found = byName(map, namesakes, name, j);
        if (found >= 0 && isTaken[static_cast<std::size_t>(found)]) found = -1;
        map.motionJoint.push_back(ofOneBody[j] >= 0 ? ofOneBody[j] : found);
    }
    if (std::all_of(map.motionJoint.begin(), map.motionJoint.end(), [](int m) { return m < 0; }))
        throw Error("retarget: no joint of the rig has a joint of the same name in the motion");
    return map;
}

namespace {

/// The largest height of an ankle above the floor, over the length of the shin.
constexpr double kMaxAnkle = 0.25;

bool hasLength(const glm::dvec3& bone, const SkeletonTree& tree) {
    return glm::length(bone) > 1e-6 * tree.reach();
}

/// The child that continues a joint's chain: the middle finger before the other fingers, these
/// before the thumb.
int rank(const JointRoles& roles, int j) {
    const JointPart part = roles.parts[static_cast<std::size_t>(j)];
    if (part == JointPart::Thumb) return 2;
    return part == JointPart::MiddleFinger ? 0 : 1;
}

/// Whether a hand's child is a finger or the hand's end, not a held thing, which has no role and
/// seldom a sibling.
bool isOfHand(const SkeletonTree& tree, const JointRoles& roles, int hand, int child) {
    const auto isKnown = [&](int j) { return !roles.roles[static_cast<std::size_t>(j)].empty(); };
    if (isKnown(child) || rank(roles, child) != 1) return true;
    const std::vector<std::string> words = nameWords(tree.joint(child).name);
    const auto has = [&](const std::string& word) {
        return std::count(words.begin(), words.end(), word) > 0;
    };
    if (has("end") || has("nub") || has("tip") || has("finger") || has("fingers")) return true;
    if (std::any_of(words.begin(), words.end(), isAccessory)) return false;
    const std::vector<int>& all = tree.children(hand);
    return all.size() > 1 && std::none_of(all.begin(), all.end(), isKnown);
}

/// A joint's bone within one skeleton: to its tip, or else to the child that continues the chain.
std::optional<glm::dvec3> ownBone(const SkeletonTree& tree, const JointRoles& roles, int j) {
    std::optional<glm::dvec3> result;
    if (tree.joint(j).tip) result = *tree.joint(j).tip - tree.centre(j);
    int best = 3;
    const bool isHand = roles.is(static_cast<std::size_t>(j), JointPart::Hand);
    if (!result || !hasLength(*result, tree))
        for (const int child : tree.children(j)) {
            if (isHand && !isOfHand(tree, roles, j, child)) continue;
            const glm::dvec3 bone = tree.centre(child) - tree.centre(j);
            const int childRank = rank(roles, child);
            if (childRank >= best || !hasLength(bone, tree)) continue;
            best = childRank;
            result = bone;
        }
    if (result && !hasLength(*result, tree)) result.reset();
    return result;
}

bool lies(const glm::dvec3& bone) {
    return std::abs(bone.y) < 0.8 * glm::length(bone);
}

/// Where an ankle is straight above the ball of the foot or above the end of the file's bone, the
/// foot's direction is that of the toes; zero if it is unknown. Steep feet that are longer, such as
/// those of a hanging body, point where their bone does.
glm::dvec3 alongSole(const SkeletonTree& tree, const JointRoles& roles, int ankle,
                     const glm::dvec3& bone) {
    const int parent = tree.joint(ankle).parent;
    if (lies(bone) || parent < 0 ||
        glm::length(bone) > kMaxAnkle * glm::distance(tree.centre(ankle), tree.centre(parent)))
        return bone;
    for (const int ball : tree.children(ankle)) {
        const std::optional<glm::dvec3> toes = ownBone(tree, roles, ball);
        if (toes && lies(*toes)) return *toes;
    }
    const glm::dvec3 heading(bone.x, 0.0, bone.z);
    return glm::length(heading) > 0.3 * glm::length(bone) ? heading : glm::dvec3(0.0);
}

/// The bone from rig joint `j` to `below` and from the one's driver to the other's.
std::optional<BonePair> boneTo(const RetargetTarget& body, int j, int below) {
    const int from = body.driver(j);
    const int to = body.driver(below);
    if (to < 0 || to == from || !body.motion.rest().isInSubtree(to, from)) return std::nullopt;
    const BonePair bone{body.rig.centre(below) - body.rig.centre(j),
                        body.motion.centre(to) - body.motion.centre(from)};
    if (!hasLength(bone.rig, body.rig) || !hasLength(bone.motion, body.motion)) return std::nullopt;
    return bone;
}

} // namespace

std::optional<BonePair> findBone(const RetargetTarget& body, int j) {
    std::optional<BonePair> result;
    int best = 3;
    std::vector<int> open = body.rig.children(j);
    while (!open.empty()) {
        const int below = open.back();
        open.pop_back();
        const std::optional<BonePair> bone = boneTo(body, j, below);
        const int childRank = rank(body.map.rig, below);
        if (bone && childRank < best) {
            best = childRank;
            result = bone;
        }
        // The joint may lie between two that match, or at its parent's centre.
        if (!bone)
            open.insert(open.end(), body.rig.children(below).begin(),
                        body.rig.children(below).end());
    }
    if (result) return result;
    const std::optional<glm::dvec3> rigBone = ownBone(body.rig, body.map.rig, j);
    const std::optional<glm::dvec3> motionBone =
        ownBone(body.motion, body.map.motion, body.driver(j));
    if (rigBone && motionBone) result = BonePair{*rigBone, *motionBone};
    return result;
}

BonePair alongSoles(const RetargetTarget& body, int j, const BonePair& bone) {
    return {alongSole(body.rig, body.map.rig, j, bone.rig),
            alongSole(body.motion, body.map.motion, body.driver(j), bone.motion)};
}

namespace {

/// A foot's bone falls from the ankle to the sole, more or less steeply from one skeleton to the
/// next, but both soles stand flat: where both feet lie, only their headings are to be aligned.
glm::dquat alignFoot(const BonePair& sole) {
    const glm::dvec3 zero(0.0);
    if (sole.rig == zero || sole.motion == zero) return {1.0, 0.0, 0.0, 0.0};
    if (!lies(sole.rig) || !lies(sole.motion)) return shortestRotation(sole.rig, sole.motion);
    return shortestRotation({sole.rig.x, 0.0, sole.rig.z}, {sole.motion.x, 0.0, sole.motion.z});
}

} // namespace

std::vector<glm::dquat> alignBones(const RetargetTarget& body) {
    const BodyParts& parts = body.rigParts;
    const glm::dquat identity(1.0, 0.0, 0.0, 0.0);
    std::vector<glm::dquat> result(parts.isLimb.size(), identity);
    for (int j = 0; j < body.rig.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        if (!parts.isLimb[index]) continue;
        std::optional<BonePair> bone;
        if (body.driver(j) >= 0) bone = findBone(body, j);
        if (bone && std::count(parts.feet.begin(), parts.feet.end(), j) > 0)
            result[index] = alignFoot(alongSoles(body, j, *bone));
        else if (bone)
            result[index] = shortestRotation(bone->rig, bone->motion);
        else
            result[index] = result[static_cast<std::size_t>(body.rig.joint(j).parent)];
    }
    return result;
}

namespace {

/// Headings this close to a quarter turn are rounded to it: actors and bodies are not quite
/// symmetric.
const double kNearlyQuarter = glm::radians(1.0);

glm::dquat uprightRotation(const BodyDirections& body) {
    const int up = body.up(2);
    if (up == 0) return {1.0, 0.0, 0.0, 0.0};
    return shortestRotation(alongAxis(up), {0.0, 1.0, 0.0});
}

/// The heading of the upright body's left side: the angle about +y from +x.
std::optional<double> heading(const BodyDirections& body, const glm::dquat& upright) {
    // Hips are rigid; captured shoulders are rarely level.
    for (const std::string part : {"UpperLeg", "UpperArm"}) {
        const glm::dvec3 left = upright * body.between("Right" + part, "Left" + part);
        if (std::hypot(left.x, left.z) > 0.8) return std::atan2(-left.z, left.x);
    }
    return std::nullopt;
}

/// A skeleton's own roles, or else those of the other skeleton's joints that it is mapped to.
JointRoles completed(const JointRoles& own, const std::vector<int>& other,
                     const JointRoles& theirs) {
    JointRoles result = own;
    for (std::size_t j = 0; j < other.size() && !own.known(); ++j) {
        if (other[j] < 0) continue;
        const std::string& role = theirs.roles[static_cast<std::size_t>(other[j])];
        if (!role.empty()) result.joints[role].push_back(static_cast<int>(j));
    }
    return result;
}

/// The turn between two files' up axes, y and z, after which the motion's bones lie just as those
/// of the rig that they drive. For skeletons without a human's joints.
glm::dquat turnOfUpAxis(const RestSkeleton& rig, const RestSkeleton& motion,
                        const JointPairs& map) {
    const glm::dvec3 x(1.0, 0.0, 0.0);
    const glm::dquat turns[] = {{1.0, 0.0, 0.0, 0.0},
                                glm::angleAxis(-glm::half_pi<double>(), x),
                                glm::angleAxis(glm::half_pi<double>(), x)};
    double alike[3] = {}, most = 0.0;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int above = rig.joints[j].parent, to = map.motionJoint[j];
        const int from = above < 0 ? -1 : map.motionJoint[static_cast<std::size_t>(above)];
        if (from < 0 || to < 0) continue;
        const glm::dvec3 ours =
            rig.joints[j].centre - rig.joints[static_cast<std::size_t>(above)].centre;
        const glm::dvec3 theirs = motion.joints[static_cast<std::size_t>(to)].centre -
                                  motion.joints[static_cast<std::size_t>(from)].centre;
        for (int turn = 0; turn < 3; ++turn) alike[turn] += glm::dot(ours, turns[turn] * theirs);
        most += glm::length(ours) * glm::length(theirs);
    }
    // Bones that another zero pose bends are no reason to lay a body down.
    for (int turn = 1; turn < 3; ++turn)
        if (alike[0] < 0.5 * most && alike[turn] > 0.95 * most) return turns[turn];
    return turns[0];
}

} // namespace

JointRoles motionRolesOf(const JointPairs& map) {
    std::vector<int> rigJoint(map.motion.roles.size(), -1);
    for (std::size_t j = 0; j < map.motionJoint.size(); ++j)
        if (map.motionJoint[j] >= 0)
            rigJoint[static_cast<std::size_t>(map.motionJoint[j])] = static_cast<int>(j);
    return completed(map.motion, rigJoint, map.rig);
}

UprightFrames findUprightFrames(const RestSkeleton& rig, const RestSkeleton& motion,
                                const JointPairs& map) {
    const JointRoles rigRoles = completed(map.rig, map.motionJoint, map.motion);
    const JointRoles motionRoles = motionRolesOf(map);
    const BodyDirections ours(rigRoles, centresOf(rig)), theirs(motionRoles, centresOf(motion));
    UprightFrames result;
    result.rigUpright = uprightRotation(ours);
    result.motionUpright = ours.up(2) == 0 && theirs.up(2) == 0 ? turnOfUpAxis(rig, motion, map)
                                                                : uprightRotation(theirs);
    const std::optional<double> to = heading(ours, result.rigUpright);
    const std::optional<double> from = heading(theirs, result.motionUpright);
    if (!to || !from) return result;
    double angle = *to - *from;
    const double quarter = glm::half_pi<double>();
    const double whole = quarter * std::round(angle / quarter);
    if (std::abs(angle - whole) < kNearlyQuarter) angle = whole;
    angle = std::remainder(angle, 4.0 * quarter);
    if (angle != 0.0)
        result.motionUpright =
            glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0)) * result.motionUpright;
    return result;
}

RestSkeleton rotated(const RestSkeleton& skeleton, const glm::dquat& rotation) {
    RestSkeleton result = skeleton;
    if (isIdentity(rotation)) return result; // to the last bit
    for (RestJoint& joint : result.joints) {
        joint.centre = rotation * joint.centre;
        if (joint.tip) joint.tip = rotation * *joint.tip;
    }
    return result;
}

} // namespace osgSkin
