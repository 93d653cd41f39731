// SPDX-License-Identifier: MIT
#include "scene/FrontOrientation.h"

#include <osgSkin/GlmOsg>
#include <osgSkinRig/BodyDirections>
#include <osgSkinRig/ForwardKinematics>

#include <osg/Math>
#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osgAnimation/Bone>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

namespace osgSkin {
namespace {

constexpr int kUpAxis = 3; ///< +Z, as BodyDirections::up() counts

/// Rotates the axis along which a figure stands to +Z.
osg::Matrixd standUp(const BodyDirections& body) {
    const int up = body.up(kUpAxis);
    if (up == 0 || up == kUpAxis) return {};
    osg::Vec3d axis;
    axis[std::abs(up) - 1] = up > 0 ? 1.0 : -1.0;
    return osg::Matrixd::rotate(axis, osg::Vec3d(0, 0, 1));
}

/// Rotates a standing figure's left side to +X.
osg::Matrixd faceAhead(const BodyDirections& body, const osg::Matrixd& stand) {
    const osg::Vec3d left =
        osg::Matrixd::transform3x3(toOsg(body.between("RightUpperLeg", "LeftUpperLeg") +
                                         body.between("RightUpperArm", "LeftUpperArm")),
                                   stand);
    // Both pairs, or the only one, must be level.
    if (std::hypot(left.x(), left.y()) < 0.8) return {};
    const double quarters = std::round(std::atan2(left.y(), left.x()) / osg::PI_2);
    if (quarters == 0.0) return {};
    return osg::Matrixd::rotate(-quarters * osg::PI_2, osg::Vec3d(0, 0, 1));
}

class Bones : public osg::NodeVisitor {
public:
    std::map<std::string, osg::Vec3d> centres;

    Bones() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) != nullptr)
            centres.emplace(node.getName(), osg::computeLocalToWorld(getNodePath()).getTrans());
        traverse(node);
    }
};

} // namespace

osg::Matrixd orientToFront(const JointRoles& roles, const JointCentres& centres,
                           const JointCentres& played) {
    if (!roles.known()) return {};
    const BodyDirections resting(roles, centres);
    const osg::Matrixd stand = standUp(resting);
    // A shape tells front from back by its feet, but not a lying figure from one in other axes.
    if (roles.family == kInferredFromGeometry)
        return stand.isIdentity() ? faceAhead(resting, stand) : osg::Matrixd();
    if (played.empty() || stand.isIdentity()) return stand * faceAhead(resting, stand);
    const BodyDirections moving(roles, played);
    const osg::Matrixd other = standUp(moving);
    if (other.isIdentity()) return faceAhead(moving, other);
    if (stand.compare(other) != 0) return {};
    return stand * faceAhead(resting, stand);
}

JointCentres restCentres(const RestSkeleton& rest, const osg::Matrixd& toWorld) {
    JointCentres result;
    for (const RestJoint& joint : rest.joints)
        result.push_back(toGlm(toOsg(joint.centre) * toWorld));
    return result;
}

JointCentres clipCentres(const RestSkeleton& rest, const Clip& clip, const osg::Matrixd& toWorld) {
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    worldRotations(rest, clip.rotations.data(), rotations);
    worldPositions(rest, rotations, clip.rootPositions.front(), centres);
    JointCentres result;
    for (const glm::dvec3& centre : centres) result.push_back(toGlm(toOsg(centre) * toWorld));
    return result;
}

JointCentres boneCentres(const RestSkeleton& rest, osg::Node& scene) {
    Bones bones;
    scene.accept(bones);
    const glm::dvec3 kUnknown(std::numeric_limits<double>::quiet_NaN());
    JointCentres result;
    for (const RestJoint& joint : rest.joints) {
        const auto found = bones.centres.find(joint.name);
        result.push_back(found == bones.centres.end() ? kUnknown : toGlm(found->second));
    }
    return result;
}

} // namespace osgSkin
