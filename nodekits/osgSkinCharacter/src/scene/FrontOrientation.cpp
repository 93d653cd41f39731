// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/FrontOrientation.h"

#include <osgSkin/GlmOsg>
#include <osgSkinRig/ForwardKinematics>

#include <osg/Math>
#include <osg/NodeVisitor>
#include <osg/Quat>
#include <osg/Transform>
#include <osgAnimation/Bone>

#include <cmath>
#include <map>
#include <string>

namespace osgSkin {
namespace {

/// A unit direction's least component along an axis to count as that axis.
constexpr double kAlong = 0.8;

class Figure {
public:
    Figure(const JointRoles& roles, const JointCentres& centres)
        : _roles(roles), _centres(centres) {}

    /// The unit direction from one part to another; zero where either is missing.
    osg::Vec3d way(const std::string& from, const std::string& to) const {
        const auto a = centre(from), b = centre(to);
        osg::Vec3d result = a && b ? *b - *a : osg::Vec3d();
        result.normalize();
        return result;
    }

private:
    std::optional<osg::Vec3d> centre(const std::string& role) const {
        const auto found = _roles.joints.find(role);
        if (found == _roles.joints.end() || found->second.empty()) return std::nullopt;
        return _centres[static_cast<std::size_t>(found->second.front())];
    }

    const JointRoles& _roles;
    const JointCentres& _centres;
};

/// The axis along a direction; zero where it lies between axes.
osg::Vec3d axisOf(osg::Vec3d way) {
    way.normalize();
    osg::Vec3d result;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(way[axis]) > kAlong) result[axis] = way[axis] > 0.0 ? 1.0 : -1.0;
    return result;
}

/// The axes along a figure's trunk, thighs and shins, upwards.
struct Stance {
    osg::Vec3d trunk, thighs, shins;

    explicit Stance(const Figure& figure)
        : trunk(axisOf(figure.way("Hips", "Head"))),
          thighs(axisOf(figure.way("LeftLowerLeg", "LeftUpperLeg") +
                        figure.way("RightLowerLeg", "RightUpperLeg"))),
          shins(axisOf(figure.way("LeftFoot", "LeftLowerLeg") +
                       figure.way("RightFoot", "RightLowerLeg"))) {}

    bool isStraight() const { return trunk == thighs && thighs == shins; }

    /// The axis that points up; zero where it is unknown.
    osg::Vec3d up() const {
        const osg::Vec3d none;
        if (trunk.z() > 0.0) return trunk; // also where the legs lie on the floor
        if (trunk != none && trunk == shins) return trunk;
        const bool isCurled = trunk != none && shins != none && thighs != trunk && thighs != shins;
        return isCurled ? none : thighs;
    }
};

/// Rotates the axis along which a figure stands to +Z.
osg::Matrixd standUp(const Figure& figure) {
    const osg::Vec3d up = Stance(figure).up();
    if (up == osg::Vec3d() || up.z() > 0.0) return {};
    osg::Quat turn;
    turn.makeRotate(up, osg::Vec3d(0, 0, 1));
    return osg::Matrixd::rotate(turn);
}

/// Rotates a standing figure's left side to +X.
osg::Matrixd faceAhead(const Figure& figure, const osg::Matrixd& stand) {
    osg::Vec3d left =
        figure.way("RightUpperLeg", "LeftUpperLeg") + figure.way("RightUpperArm", "LeftUpperArm");
    left = osg::Matrixd::transform3x3(left, stand);
    // Both pairs, or the only one, must be level.
    if (std::hypot(left.x(), left.y()) < kAlong) return {};
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
    if (!roles.known() || roles.family == kInferredFromGeometry) return {};
    const Figure resting(roles, centres);
    const osg::Matrixd stand = standUp(resting);
    if (played.empty() || stand.isIdentity()) return stand * faceAhead(resting, stand);
    const Figure moving(roles, played);
    const osg::Matrixd other = standUp(moving);
    if (other.isIdentity()) return faceAhead(moving, other);
    if (stand.compare(other) != 0) return {};
    return stand * faceAhead(resting, stand);
}

bool isStraight(const JointRoles& roles, const JointCentres& centres) {
    return Stance(Figure(roles, centres)).isStraight();
}

JointCentres restCentres(const RestSkeleton& rest, const osg::Matrixd& toWorld) {
    JointCentres result;
    for (const RestJoint& joint : rest.joints) result.emplace_back(toOsg(joint.centre) * toWorld);
    return result;
}

JointCentres clipCentres(const RestSkeleton& rest, const Clip& clip, const osg::Matrixd& toWorld) {
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    worldRotations(rest, clip.rotations.data(), rotations);
    worldPositions(rest, rotations, clip.rootPositions.front(), centres);
    JointCentres result;
    for (const glm::dvec3& centre : centres) result.emplace_back(toOsg(centre) * toWorld);
    return result;
}

JointCentres boneCentres(const RestSkeleton& rest, osg::Node& scene) {
    Bones bones;
    scene.accept(bones);
    JointCentres result;
    for (const RestJoint& joint : rest.joints) {
        const auto found = bones.centres.find(joint.name);
        result.push_back(found == bones.centres.end() ? std::nullopt
                                                      : std::optional(found->second));
    }
    return result;
}

} // namespace osgSkin
