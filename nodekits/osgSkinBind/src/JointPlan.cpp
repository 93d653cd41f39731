// SPDX-License-Identifier: GPL-3.0-or-later
#include "JointPlan.h"

#include "InsideSkin.h"
#include "JointAxes.h"
#include "JointNames.h"
#include "RigidJoints.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// Joint centres closer than this share of the mesh's size are one point.
constexpr double kCentreTolerance = 1e-6;

bool hasParentPole(const JointBindOptions& options, const std::string& name) {
    if (options.twistPole == JointBindOptions::Pole::Automatic) return isHandName(name);
    return options.twistPole == JointBindOptions::Pole::Parent;
}

/// True where an earlier joint that may hold a region has the same centre.
bool coincides(const std::vector<PlannedJoint>& joints, std::size_t joint, double tolerance) {
    for (std::size_t other = 0; other < joint; ++other)
        if (joints[other].holdsRegion &&
            glm::distance(joints[other].centre, joints[joint].centre) <= tolerance)
            return true;
    return false;
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
    const std::vector<int> rigid = rigidJoints(skeleton, options);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::string& name = skeleton.joints[j].name;
        joints[j].rigid = rigid[j];
        const auto found = options.joints.find(name);
        if (found != options.joints.end()) joints[j].options = found->second;
        joints[j].poleIsParent =
            skeleton.joints[j].parent >= 0 && hasParentPole(joints[j].options, name);
    }
    setJointAxes(skeleton, tolerance, joints);

    std::vector<std::size_t> outside;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        PlannedJoint& joint = joints[j];
        if (joint.options.skip || coincides(joints, j, tolerance)) continue;
        joint.seeds = joint.holdsRegion = true;
        if (!isInsideSkin(mesh, joint.centre)) outside.push_back(j);
    }
    const auto seeding = std::count_if(joints.begin(), joints.end(),
                                       [](const PlannedJoint& joint) { return joint.seeds; });
    const bool allOutside = static_cast<std::size_t>(seeding) == outside.size();
    if (allOutside)
        notes.emplace_back("no joint lies inside the skin: regions by the nearest bone");
    for (const std::size_t j : outside) {
        joints[j].seeds = false;
        if (allOutside) continue;
        joints[j].holdsRegion = false;
        notes.push_back("joint \"" + skeleton.joints[j].name + "\" lies outside the skin");
    }
    giveRegionsToRigidJoints(joints);
    return joints;
}

} // namespace osgSkin
