// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointPlan.h"

#include "joints/BodyAxes.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkinBind/RigidJoints>

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The offset from the nearest ancestor that lies elsewhere; zero for the root.
glm::dvec3 offsetFromAbove(const RestSkeleton& skeleton, std::size_t joint, double tolerance) {
    for (int p = skeleton.joints[joint].parent; p >= 0; p = skeleton.joints[at(p)].parent) {
        const glm::dvec3 d = skeleton.joints[joint].centre - skeleton.joints[at(p)].centre;
        if (glm::length(d) > tolerance) return d;
    }
    return glm::dvec3(0.0);
}

std::vector<std::size_t> subtreeSizes(const RestSkeleton& skeleton) {
    std::vector<std::size_t> sizes(skeleton.joints.size(), 1);
    for (std::size_t j = skeleton.joints.size(); j-- > 1;)
        sizes[at(skeleton.joints[j].parent)] += sizes[j];
    return sizes;
}

/// The child that continues the chain. Of several, the thumb is the last choice. From the root it
/// is the one with the most joints (the spine, not a leg), elsewhere the one in the straightest
/// direction (the neck, not a collar bone).
int mainChild(const RestSkeleton& skeleton, std::size_t joint,
              const std::vector<std::size_t>& sizes, const std::vector<PlannedJoint>& planned,
              double tolerance) {
    const std::vector<int> children = skeleton.children(static_cast<int>(joint));
    const glm::dvec3 incoming = offsetFromAbove(skeleton, joint, tolerance);
    int best = -1;
    bool bestIsThumb = true;
    double bestScore = 0.0;
    for (const int child : children) {
        const glm::dvec3 toBoneEnd = planned[at(child)].boneEnd - skeleton.joints[joint].centre;
        const glm::dvec3 direct = skeleton.joints[at(child)].centre - skeleton.joints[joint].centre;
        const glm::dvec3 along = glm::length(direct) > tolerance ? direct : toBoneEnd;
        const double length = glm::length(along);
        const bool thumb = planned[at(child)].part == JointPart::Thumb;
        const double score = incoming == glm::dvec3(0.0)
                                 ? static_cast<double>(sizes[at(child)])
                                 : (length > tolerance ? glm::dot(along, incoming) / length : -2.0);
        if (best < 0 || (bestIsThumb && !thumb) || (bestIsThumb == thumb && score > bestScore)) {
            best = child;
            bestIsThumb = thumb;
            bestScore = score;
        }
    }
    return best;
}

/// Sets centre, parent, child, bone and axes of the joints. Centres closer than `tolerance` are one
/// point.
/// \pre the joints' parts are set
void setJointAxes(const RestSkeleton& skeleton, double tolerance,
                  std::vector<PlannedJoint>& joints) {
    const std::vector<std::size_t> sizes = subtreeSizes(skeleton);
    // Leaves first, since a bone without a length ends where its child's bone ends.
    for (std::size_t j = joints.size(); j-- > 0;) {
        const RestJoint& rest = skeleton.joints[j];
        PlannedJoint& joint = joints[j];
        joint.centre = rest.centre;
        joint.parent = rest.parent;
        joint.child = mainChild(skeleton, j, sizes, joints, tolerance);
        joint.boneEnd = rest.tip ? *rest.tip : rest.centre;
        if (joint.child >= 0) {
            const PlannedJoint& child = joints[at(joint.child)];
            joint.boneEnd = glm::distance(child.centre, joint.centre) > tolerance ? child.centre
                                                                                  : child.boneEnd;
        }
        joint.boneLength = glm::distance(joint.boneEnd, joint.centre);
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
        PlannedJoint& joint = joints[j];
        const PlannedJoint* parent = joint.parent >= 0 ? &joints[at(joint.parent)] : nullptr;
        if (joint.boneLength > tolerance)
            joint.boneAxis = (joint.boneEnd - joint.centre) / joint.boneLength;
        else
            joint.boneAxis = parent ? parent->boneAxis : glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 above = offsetFromAbove(skeleton, j, tolerance);
        joint.lengthAbove = glm::length(above);
        joint.comingFrom = joint.lengthAbove > 0.0 ? above / joint.lengthAbove : joint.boneAxis;
        joint.twistAxis = joint.poleIsParent ? joint.comingFrom : joint.boneAxis;
        joint.poleLength = joint.poleIsParent ? joint.lengthAbove : joint.boneLength;
    }
}

/// The topmost heads, hands and feet, in joint order. The root is never one of them.
std::vector<std::size_t> extremities(const RestSkeleton& skeleton, const JointRoles& roles) {
    std::vector<std::size_t> result;
    std::vector<bool> inside(skeleton.joints.size(), false);
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        inside[j] = inside[at(skeleton.joints[j].parent)];
        if (inside[j]) continue;
        for (const JointPart part : {JointPart::Head, JointPart::Hand, JointPart::Foot})
            if (roles.is(j, part)) inside[j] = true;
        if (inside[j]) result.push_back(j);
    }
    return result;
}

/// For each joint the topmost rigid joint at or above it, or -1.
/// \throw osgSkin::Error if an option names a joint that does not exist
std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options) {
    const std::map<std::string, int> jointOf = skeleton.byName();
    std::vector<bool> named(skeleton.joints.size(), false);
    for (const std::string& name :
         options.rigid ? *options.rigid : automaticRigidJoints(skeleton, options.names)) {
        const auto joint = jointOf.find(name);
        if (joint == jointOf.end())
            throw Error("bind: rigid joint \"" + name + "\" is not in the skeleton" +
                        expectedNames(name, jointOf));
        named[at(joint->second)] = true;
    }
    std::vector<int> result(skeleton.joints.size(), -1);
    for (std::size_t j = 0; j < result.size(); ++j) {
        const int parent = skeleton.joints[j].parent;
        if (parent >= 0) result[j] = result[at(parent)];
        if (result[j] < 0 && named[j]) result[j] = static_cast<int>(j);
    }
    return result;
}

bool hasParentPole(const JointBindOptions& options, JointPart part) {
    if (options.twistAxis == JointBindOptions::Pole::Automatic) return part == JointPart::Hand;
    return options.twistAxis == JointBindOptions::Pole::Parent;
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The earlier joint with the same centre that may have a region, or kNone.
std::size_t coincident(const std::vector<PlannedJoint>& joints, std::size_t joint,
                       double tolerance) {
    for (std::size_t other = 0; other < joint; ++other)
        if (joints[other].holdsRegion() &&
            glm::distance(joints[other].centre, joints[joint].centre) <= tolerance)
            return other;
    return kNone;
}

/// The rank of a joint among joints at one point: recognised joints come before helpers (a target,
/// a twist, another rig's copy), then joints with children before those without.
int standing(const RestSkeleton& skeleton, const JointRoles& roles, std::size_t joint) {
    return (roles.roles[joint].empty() ? 0 : 2) +
           (skeleton.children(static_cast<int>(joint)).empty() ? 0 : 1);
}

/// True if the bones of two joints at one point end at different points.
bool haveOwnBones(const PlannedJoint& a, const PlannedJoint& b, double tolerance) {
    return a.boneLength > tolerance && b.boneLength > tolerance &&
           glm::distance(a.boneEnd, b.boneEnd) > tolerance;
}

/// Gives a region to every joint that is not skipped and has a centre of its own. Of joints at one
/// point the topmost gets it, unless only the other one has a role. If neither is below the other,
/// the one of higher standing() gets it; if these are equal, both get one if their bones differ,
/// else none.
///
/// \param tellsBonesApart whether regions are found by samples along bones
void giveRegions(const RestSkeleton& skeleton, const JointRoles& roles, double tolerance,
                 bool tellsBonesApart, std::vector<PlannedJoint>& joints,
                 std::vector<std::string>& notes) {
    std::vector<std::size_t> rivals;
    std::string note;                              // about the first ones
    std::vector<bool> helps(joints.size(), false); // of lower standing than another joint
    const auto give = [&joints](std::size_t joint, bool gets) {
        joints[joint].region = gets ? RegionSource::Bones : RegionSource::None;
    };
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].options.skip) continue;
        const std::size_t other = coincident(joints, j, tolerance);
        give(j, other == kNone);
        if (other == kNone) continue;
        if (skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(other))) {
            // A foot below its IK target.
            const bool isBelowTarget = roles.roles[other].empty() && !roles.roles[j].empty();
            give(j, isBelowTarget);
            give(other, !isBelowTarget);
            continue;
        }
        const int more = standing(skeleton, roles, j) - standing(skeleton, roles, other);
        if (more == 0) {
            if (tellsBonesApart && haveOwnBones(joints[other], joints[j], tolerance)) {
                give(j, true);
                continue;
            }
            if (rivals.empty())
                note = "joints \"" + skeleton.joints[other].name + "\" and \"" +
                       skeleton.joints[j].name +
                       "\" are at one point, so neither has a region of its own";
            rivals.push_back(other);
            continue;
        }
        helps[more > 0 ? other : j] = true;
        give(other, more < 0);
        give(j, more > 0);
    }
    for (const std::size_t rival : rivals) give(rival, false);
    if (rivals.size() > 1)
        note += "; the same applies to " + std::to_string(rivals.size() - 1) + " more";
    if (!rivals.empty()) notes.push_back(note);
    // Joints below a helper are helpers, too, such as further links of a twist.
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!helps[at(skeleton.joints[j].parent)]) continue;
        if (roles.roles[j].empty()) helps[j] = true;
    }
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (helps[j]) joints[j].region = RegionSource::Helper;
}

/// A rigid joint owns the seeds of its descendants, so it has a region even without seeds.
void giveRegionsToRigidJoints(std::vector<PlannedJoint>& joints) {
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].rigid >= 0 && joints[j].holdsRegion() &&
            !joints[at(joints[j].rigid)].holdsRegion())
            joints[at(joints[j].rigid)].region = RegionSource::Bones;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].belowRigid(static_cast<int>(j))) joints[j].region = RegionSource::None;
}

} // namespace

std::vector<std::string> automaticRigidJoints(const RestSkeleton& skeleton,
                                              const std::vector<JointNames>& names,
                                              const std::vector<bool>& isMoved) {
    const JointRoles roles = recogniseJoints(skeleton, names);
    std::vector<std::string> result;
    for (const std::size_t joint : extremities(skeleton, roles)) {
        bool bends = false;
        for (std::size_t j = joint + 1; j < skeleton.joints.size() && !bends; ++j) {
            if (!skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) continue;
            const bool isEnd = !skeleton.joints[j].tip && roles.roles[j].empty() &&
                               skeleton.children(static_cast<int>(j)).empty();
            const JointPart part = roles.parts[j];
            const bool isSame = part == JointPart::Head || part == JointPart::Hand ||
                                part == JointPart::Foot; // a hand below its wrist
            bends = !isEnd && !isSame && (isMoved.empty() || isMoved[j]);
        }
        if (!bends) result.push_back(skeleton.joints[joint].name);
    }
    return result;
}

glm::dvec3 planeNormal(const PlannedJoint& joint) {
    const bool isSpine = joint.isSpine() && joint.lengthAbove > 0.0 && joint.boneLength > 0.0;
    const glm::dvec3 sum =
        isSpine ? joint.lengthAbove * joint.comingFrom + joint.boneLength * joint.boneAxis
                : joint.comingFrom + joint.boneAxis;
    const double length = glm::length(sum);
    return length > 1e-6 * (joint.lengthAbove + joint.boneLength)
               ? sum / length
               : joint.boneAxis; // a bone that folds straight back
}

double distanceToBone(const PlannedJoint& joint, const glm::dvec3& point) {
    const glm::dvec3 d = point - joint.centre;
    const double along = std::clamp(glm::dot(d, joint.boneAxis), 0.0, joint.boneLength);
    return glm::length(d - along * joint.boneAxis);
}

std::vector<bool> subtreeOf(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    std::vector<bool> inside(joints.size(), false);
    inside[joint] = true;
    for (std::size_t j = joint + 1; j < joints.size(); ++j) // parents first
        if (joints[j].parent >= 0) inside[j] = inside[at(joints[j].parent)];
    return inside;
}

std::size_t regionAbove(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    int above = joints[joint].parent;
    while (above > 0 && !joints[at(above)].holdsRegion()) above = joints[at(above)].parent;
    return static_cast<std::size_t>(std::max(above, 0));
}

std::vector<PlannedJoint> planJoints(const RestSkeleton& skeleton, const WeldedMesh& mesh,
                                     const BindOptions& options, std::vector<std::string>& notes) {
    std::vector<PlannedJoint> joints(skeleton.joints.size());
    const double tolerance = kCentreTolerance * mesh.size;
    const JointRoles roles = recogniseJoints(skeleton, options.names);
    if (roles.family == kInferredFromGeometry)
        notes.emplace_back("joint names not recognised: head, hands and feet are inferred from the "
                           "skeleton's shape");
    const std::vector<int> rigid = rigidJoints(skeleton, options);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        joints[j].part = roles.parts[j];
        joints[j].rigid = rigid[j];
        const auto found = options.joints.find(skeleton.joints[j].name);
        if (found != options.joints.end()) joints[j].options = found->second;
        joints[j].poleIsParent =
            skeleton.joints[j].parent >= 0 && hasParentPole(joints[j].options, joints[j].part);
    }
    for (const std::size_t joint : extremities(skeleton, roles))
        joints[joint].kind = JointKind::Extremity;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& above = joints[at(skeleton.joints[j].parent)];
        if (joints[j].rigid < 0 && (above.isExtremity() || above.isDigit()))
            joints[j].kind = JointKind::Digit;
    }
    setJointAxes(skeleton, tolerance, joints);
    markTrunk(joints);

    giveRegions(skeleton, roles, tolerance, options.method == BindOptions::Method::Smooth, joints,
                notes);
    setSamples(skeleton, mesh, roles, options.method, joints, notes);
    giveRegionsToRigidJoints(joints);
    // If the root is on the floor, the first joint with skin moves all of it. The paper's method,
    // which uses only centres, cannot distinguish such a root from one at the end of the skin.
    const bool isSmooth = options.method == BindOptions::Method::Smooth;
    const auto first = std::find_if(joints.begin(), joints.end(),
                                    [](const PlannedJoint& joint) { return joint.holdsRegion(); });
    for (std::size_t j = 1; j < joints.size(); ++j)
        joints[j].topmost = (roles.roles[j] == "Hips" || (isSmooth && &joints[j] == &*first)) &&
                            !joints[regionAbove(joints, j)].holdsRegion();
    return joints;
}

std::vector<BoundJoint> boundJoints(const RestSkeleton& skeleton,
                                    const std::vector<PlannedJoint>& joints) {
    std::vector<BoundJoint> result;
    for (std::size_t j = 0; j < joints.size(); ++j)
        result.push_back({skeleton.joints[j].name, joints[j].parent, joints[j].centre,
                          joints[j].boneAxis, joints[j].twistAxis});
    return result;
}

} // namespace osgSkin
