// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointRegions.h"

#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
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
    const double tolerance = kCentreTolerance * mesh.size;
    const JointRoles roles = recogniseJoints(skeleton, options.names);
    if (roles.family == kInferredFromGeometry)
        notes.emplace_back("joint names not recognised: head, hands and feet are inferred from the "
                           "skeleton's shape");
    std::vector<PlannedJoint> joints = planAxes(skeleton, mesh, roles, options);
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

} // namespace osgSkin
