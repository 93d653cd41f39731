// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointPlan.h"

#include "joints/BoneSamples.h"
#include "joints/JointAxes.h"
#include "joints/RigidJoints.h"
#include "joints/TrunkJoints.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

bool hasParentPole(const JointBindOptions& options, JointPart part) {
    if (options.twistPole == JointBindOptions::Pole::Automatic) return part == JointPart::Hand;
    return options.twistPole == JointBindOptions::Pole::Parent;
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The earlier joint of the same centre that may have a region, kNone where there is none.
std::size_t coincident(const std::vector<PlannedJoint>& joints, std::size_t joint,
                       double tolerance) {
    for (std::size_t other = 0; other < joint; ++other)
        if (joints[other].holdsRegion &&
            glm::distance(joints[other].centre, joints[joint].centre) <= tolerance)
            return other;
    return kNone;
}

/// How much of a body's joint one is beside another in the same point: one that is recognised more
/// than a helper (a target, a twist, another rig's copy), one that leads on more than one that
/// ends.
int standing(const RestSkeleton& skeleton, const JointRoles& roles, std::size_t joint) {
    return (roles.roles[joint].empty() ? 0 : 2) +
           (skeleton.children(static_cast<int>(joint)).empty() ? 0 : 1);
}

/// Whether two joints in one point have bones that end apart.
bool haveOwnBones(const PlannedJoint& a, const PlannedJoint& b, double tolerance) {
    return a.boneLength > tolerance && b.boneLength > tolerance &&
           glm::distance(a.boneEnd, b.boneEnd) > tolerance;
}

/// Every joint that is not skipped and has a centre of its own gets a region. Of joints in one
/// point the topmost gets it, unless it has no role and the other one has. Where they stand beside
/// each other, the one that is more of a joint; where they are alike, each whose bone tells it
/// apart, else none.
///
/// \param tellsBonesApart whether regions are found by samples along bones
void giveRegions(const RestSkeleton& skeleton, const JointRoles& roles, double tolerance,
                 bool tellsBonesApart, std::vector<PlannedJoint>& joints,
                 std::vector<std::string>& notes) {
    std::vector<std::size_t> rivals;
    std::string note;                              // of the first ones
    std::vector<bool> helps(joints.size(), false); // beside a joint that is more of one
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].options.skip) continue;
        const std::size_t other = coincident(joints, j, tolerance);
        joints[j].holdsRegion = other == kNone;
        if (other == kNone) continue;
        if (skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(other))) {
            // A foot below its IK target.
            joints[j].holdsRegion = roles.roles[other].empty() && !roles.roles[j].empty();
            joints[other].holdsRegion = !joints[j].holdsRegion;
            continue;
        }
        const int more = standing(skeleton, roles, j) - standing(skeleton, roles, other);
        if (more == 0) {
            if (tellsBonesApart && haveOwnBones(joints[other], joints[j], tolerance)) {
                joints[j].holdsRegion = true;
                continue;
            }
            if (rivals.empty())
                note = "joints \"" + skeleton.joints[other].name + "\" and \"" +
                       skeleton.joints[j].name +
                       "\" are in one place, neither has a region of its own";
            rivals.push_back(other);
            continue;
        }
        helps[more > 0 ? other : j] = true;
        joints[other].holdsRegion = more < 0;
        joints[j].holdsRegion = more > 0;
    }
    for (const std::size_t rival : rivals) joints[rival].holdsRegion = false;
    if (rivals.size() > 1) note += "; nor have " + std::to_string(rivals.size() - 1) + " more";
    if (!rivals.empty()) notes.push_back(note);
    // What hangs on a helper helps, too: the further links of a twist.
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!helps[static_cast<std::size_t>(skeleton.joints[j].parent)]) continue;
        if (!roles.roles[j].empty()) continue;
        helps[j] = true;
        joints[j].holdsRegion = false;
    }
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j].helper = helps[j];
}

/// A rigid joint owns what its descendants seed, so it has a region although it may seed none.
void giveRegionsToRigidJoints(std::vector<PlannedJoint>& joints) {
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].rigid >= 0 && joints[j].holdsRegion)
            joints[static_cast<std::size_t>(joints[j].rigid)].holdsRegion = true;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].belowRigid(static_cast<int>(j))) joints[j].holdsRegion = false;
}

} // namespace

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
        if (joints[j].parent >= 0) inside[j] = inside[static_cast<std::size_t>(joints[j].parent)];
    return inside;
}

std::size_t regionAbove(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    int above = joints[joint].parent;
    while (above > 0 && !joints[static_cast<std::size_t>(above)].holdsRegion)
        above = joints[static_cast<std::size_t>(above)].parent;
    return static_cast<std::size_t>(std::max(above, 0));
}

std::vector<PlannedJoint> planJoints(const RestSkeleton& skeleton, const WeldedMesh& mesh,
                                     const BindOptions& options, std::vector<std::string>& notes) {
    std::vector<PlannedJoint> joints(skeleton.joints.size());
    const double tolerance = kCentreTolerance * mesh.size;
    const JointRoles roles = recogniseJoints(skeleton, options.names);
    if (roles.family == kToldByShape)
        notes.emplace_back("the joints' names say nothing: head, hands and feet by their shape");
    const std::vector<int> rigid = rigidJoints(skeleton, options);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        joints[j].part = roles.parts[j];
        joints[j].rigid = rigid[j];
        const auto found = options.joints.find(skeleton.joints[j].name);
        if (found != options.joints.end()) joints[j].options = found->second;
        joints[j].poleIsParent =
            skeleton.joints[j].parent >= 0 && hasParentPole(joints[j].options, joints[j].part);
    }
    for (const std::size_t joint : extremities(skeleton, roles)) joints[joint].extremity = true;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& above = joints[static_cast<std::size_t>(skeleton.joints[j].parent)];
        joints[j].digit = joints[j].rigid < 0 && (above.extremity || above.digit);
    }
    setJointAxes(skeleton, tolerance, joints);
    markTrunk(joints);

    giveRegions(skeleton, roles, tolerance, options.method == BindOptions::Method::Smooth, joints,
                notes);
    setSamples(skeleton, mesh, roles, options.method, joints, notes);
    giveRegionsToRigidJoints(joints);
    // With a root on the floor, the first joint with skin moves all of it. By its centre alone, as
    // the printed method has it, nobody can tell such a root from one at the skin's end.
    const bool isSmooth = options.method == BindOptions::Method::Smooth;
    const auto first = std::find_if(joints.begin(), joints.end(),
                                    [](const PlannedJoint& joint) { return joint.holdsRegion; });
    for (std::size_t j = 1; j < joints.size(); ++j)
        joints[j].topmost = (roles.roles[j] == "Hips" || (isSmooth && &joints[j] == &*first)) &&
                            !joints[regionAbove(joints, j)].holdsRegion;
    return joints;
}

} // namespace osgSkin
