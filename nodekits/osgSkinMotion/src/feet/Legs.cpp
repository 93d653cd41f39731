// SPDX-License-Identifier: MIT
#include "feet/Legs.h"

#include "bones/TwoBone.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <algorithm>
#include <vector>

namespace osgSkin {
namespace {

// Leg lengths.
constexpr double kBallAhead = 0.2, kBallBelow = 0.06; ///< of the ankle, without a toe's joint
constexpr double kFootLength = 0.35;                  ///< from the ankle to the end of a foot
constexpr double kSole = 0.04;                        ///< above the floor, of a sole's vertices

/// The vertices of a character in its rest pose.
class FindVertices : public osg::NodeVisitor {
public:
    FindVertices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void in(osg::Node& node, const glm::dmat4& toSpace) {
        _toSpace = toSpace;
        node.accept(*this);
    }
    void apply(osg::Drawable& drawable) override {
        const auto* skin = dynamic_cast<const DeformableSkin*>(&drawable);
        const osg::Geometry* geometry = skin ? skin->getRestGeometry() : drawable.asGeometry();
        const auto* array =
            geometry ? dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray()) : nullptr;
        if (!array) return;
        const glm::dmat4 toSpace = _toSpace * toGlm(osg::computeLocalToWorld(getNodePath()));
        for (const osg::Vec3& vertex : *array)
            vertices.push_back(transformPoint(toSpace, toGlm(osg::Vec3d(vertex))));
    }
    std::vector<glm::dvec3> vertices; ///< the space of `toSpace`

private:
    glm::dmat4 _toSpace{1.0};
};

} // namespace

RestLegs findLegs(const RestSkeleton& rest, const JointRoles& roles, const glm::dmat4& toLevel,
                  const std::optional<glm::dvec3>& forward, const std::string& user) {
    const auto jointOf = [&](const std::string& role) {
        const int joint = roles.joint(role);
        if (joint < 0)
            throw Error(user + ": the character's skeleton has no joint that is known as " + role);
        return static_cast<std::size_t>(joint);
    };
    const auto placeOf = [&](std::size_t joint) {
        return transformPoint(toLevel, rest.joints[joint].centre);
    };
    RestLegs legs;
    glm::dvec3 ahead(0.0);
    std::array<bool, 2> hasBall{};
    for (std::size_t side = 0; side < legs.sides.size(); ++side) {
        const std::string name = side == 0 ? "Left" : "Right";
        RestLeg& leg = legs.sides[side];
        leg.hip = jointOf(name + "UpperLeg");
        leg.knee = jointOf(name + "LowerLeg");
        leg.ankle = leg.toe = jointOf(name + "Foot");
        leg.ankleCentre = placeOf(leg.ankle);
        const glm::dvec3 knee = placeOf(leg.knee);
        legs.length +=
            0.5 * (glm::distance(knee, placeOf(leg.hip)) + glm::distance(leg.ankleCentre, knee));
        const int toe = roles.joint(name + "Toe");
        if (toe < 0) continue;
        if (rest.isInSubtree(toe, static_cast<int>(leg.ankle)))
            leg.toe = static_cast<std::size_t>(toe);
        hasBall[side] = true;
        leg.ball = placeOf(static_cast<std::size_t>(toe));
        ahead += level(leg.ball - leg.ankleCentre);
    }
    if (forward || glm::length(ahead) > 0.0) legs.forward = forward ? *forward : unitOrZero(ahead);
    for (std::size_t side = 0; side < legs.sides.size(); ++side)
        if (RestLeg& leg = legs.sides[side]; !hasBall[side])
            leg.ball = leg.ankleCentre +
                       legs.length * (kBallAhead * legs.forward - glm::dvec3(0.0, 0.0, kBallBelow));
    return legs;
}

void measureSoles(const ClipCharacter& character, const glm::dmat4& toLevel, RestLegs& legs) {
    const glm::dmat4 fromWorld = toLevel * glm::inverse(toGlm(character.toWorld()));
    FindVertices find;
    for (const ClipCharacter::Skin& skin : character.skins())
        find.in(*skin.skin, fromWorld * toGlm(skin.toWorld));
    for (const ClipCharacter::Rigid& rigid : character.rigids())
        for (const osg::ref_ptr<osg::Node>& part : rigid.parts) find.in(*part, toLevel);
    for (std::size_t side = 0; side < legs.sides.size(); ++side) {
        RestLeg& leg = legs.sides[side];
        const glm::dvec3& other = legs.sides[1 - side].ankleCentre;
        std::vector<glm::dvec3> vertices;
        double floor = leg.ball.z;
        for (const glm::dvec3& vertex : find.vertices) {
            const double away = glm::length(level(vertex - leg.ankleCentre));
            if (vertex.z > leg.ankleCentre.z || away > kFootLength * legs.length ||
                away > glm::length(level(vertex - other)))
                continue;
            vertices.push_back(vertex);
            floor = std::min(floor, vertex.z);
        }
        double rear = glm::dot(leg.ball, legs.forward), front = rear;
        for (const glm::dvec3& vertex : vertices) {
            if (vertex.z > floor + kSole * legs.length) continue;
            rear = std::min(rear, glm::dot(vertex, legs.forward));
            front = std::max(front, glm::dot(vertex, legs.forward));
        }
        const auto onFloor = [&](const glm::dvec3& beside, double ahead) {
            const glm::dvec3 place =
                beside + legs.forward * (ahead - glm::dot(beside, legs.forward));
            return glm::dvec3(place.x, place.y, floor);
        };
        leg.heel = onFloor(leg.ankleCentre, rear);
        leg.tip = onFloor(leg.ball, front);
    }
}

} // namespace osgSkin
