// SPDX-License-Identifier: MIT
#include "retarget/UprightFrames.h"

#include "skeleton/NearAxis.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// Headings this near to a quarter turn are one: actors and bodies are not quite symmetric.
const double kNearlyQuarter = glm::radians(1.0);

/// One skeleton with its joints' roles, its own or else those of the joints they are mapped to.
class Body {
public:
    Body(const SkeletonTree& tree, const std::vector<std::string>& roles)
        : _tree(tree), _roles(roles) {}

    /// From one part of the body to another, of those that are there on this side; zero where not.
    glm::dvec3 bone(const std::string& from, const std::string& to) const {
        const std::optional<glm::dvec3> a = centre(from), b = centre(to);
        return a && b ? *b - *a : glm::dvec3(0.0);
    }

    double reach() const { return _tree.reach(); }

private:
    std::optional<glm::dvec3> centre(const std::string& role) const {
        for (std::size_t j = 0; j < _roles.size(); ++j)
            if (_roles[j] == role) return _tree.centre(static_cast<int>(j));
        return std::nullopt;
    }

    const SkeletonTree& _tree;
    const std::vector<std::string>& _roles;
};

/// Up, as nearAxis() has it: along the thighs, or where trunk and shins stand along one axis along
/// that, since who sits holds the thighs before him. On the floor the legs may lie, and the trunk
/// alone stand.
int upOf(const Body& body) {
    glm::dvec3 thighs(0.0), shins(0.0), trunk(0.0);
    for (const std::string side : {"Left", "Right"}) {
        thighs += body.bone(side + "LowerLeg", side + "UpperLeg");
        shins += body.bone(side + "Foot", side + "LowerLeg");
        glm::dvec3 top = body.bone(side + "UpperLeg", "Neck");
        if (top == glm::dvec3(0.0)) top = body.bone(side + "UpperLeg", "Head");
        if (top == glm::dvec3(0.0)) top = body.bone(side + "UpperLeg", side + "UpperArm");
        trunk += top;
    }
    const int byTrunk = nearAxis(trunk);
    if (byTrunk == 2) return byTrunk;
    return byTrunk == nearAxis(shins) && byTrunk != 0 ? byTrunk : nearAxis(thighs);
}

glm::dquat uprightRotation(const Body& body) {
    const int up = upOf(body);
    // Legs that are drawn up, or none: nothing tells.
    if (up == 0 || up == 2) return {1.0, 0.0, 0.0, 0.0};
    glm::dvec3 along(0.0);
    along[std::abs(up) - 1] = up > 0 ? 1.0 : -1.0;
    return shortestRotation(along, {0.0, 1.0, 0.0});
}

/// The heading of the body's left side, counted about +y from +x, once it stands upright.
std::optional<double> heading(const Body& body, const glm::dquat& upright) {
    // Hips are stiff; shoulders, in the capture of an actor, are rarely level with each other.
    for (const std::string part : {"UpperLeg", "UpperArm"}) {
        const glm::dvec3 left = upright * body.bone("Right" + part, "Left" + part);
        const double across = std::hypot(left.x, left.z);
        if (across > 1e-3 * body.reach() && across > 0.8 * glm::length(left))
            return std::atan2(-left.z, left.x);
    }
    return std::nullopt;
}

std::vector<std::string> completed(const std::vector<std::string>& own,
                                   const std::vector<int>& other,
                                   const std::vector<std::string>& theirs) {
    std::vector<std::string> roles = own;
    for (std::size_t j = 0; j < roles.size(); ++j)
        if (other[j] >= 0) roles[j] = theirs[static_cast<std::size_t>(other[j])];
    return roles;
}

std::vector<int> inverse(const std::vector<int>& motionJoint, std::size_t motionJoints) {
    std::vector<int> result(motionJoints, -1);
    for (std::size_t j = 0; j < motionJoint.size(); ++j)
        if (motionJoint[j] >= 0)
            result[static_cast<std::size_t>(motionJoint[j])] = static_cast<int>(j);
    return result;
}

} // namespace

UprightFrames findUprightFrames(const SkeletonTree& rig, const SkeletonTree& motion,
                                const JointPairs& map) {
    std::vector<std::string> rigRoles = map.rig.roles, motionRoles = map.motion.roles;
    if (!map.rig.known()) rigRoles = completed(rigRoles, map.motionJoint, motionRoles);
    if (!map.motion.known())
        motionRoles =
            completed(motionRoles, inverse(map.motionJoint, motionRoles.size()), rigRoles);
    const Body ours(rig, rigRoles), theirs(motion, motionRoles);
    UprightFrames result;
    result.rigUpright = uprightRotation(ours);
    result.motionUpright = uprightRotation(theirs);
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
