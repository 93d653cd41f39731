// SPDX-License-Identifier: MIT
#include <osgSkinMotion/GroundFeet>

#include "bones/BoneCallbacks.h"
#include "ground/LegsOnGround.h"
#include "walk/GaitCycle.h"
#include "walk/Soles.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/RotateBone>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/ReadSkeleton>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osgAnimation/Skeleton>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgSkin {
namespace {

constexpr double kRange = 0.6; ///< leg lengths above and below the clips' floor

bool intersect(osg::Node& node, osg::Node::NodeMask mask, const osg::Vec3d& above,
               const osg::Vec3d& below, GroundFeet::Surface& surface) {
    const osg::NodePathList paths = node.getParentalNodePaths();
    osg::NodePath path = paths.empty() ? osg::NodePath() : paths.front();
    if (!path.empty()) path.pop_back(); // the visitor takes the node's own transform
    const osg::Matrixd toWorld = osg::computeLocalToWorld(path);
    const osg::Matrixd fromWorld = osg::Matrixd::inverse(toWorld);
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line = new osgUtil::LineSegmentIntersector(
        osgUtil::Intersector::MODEL, above * fromWorld, below * fromWorld);
    line->setIntersectionLimit(osgUtil::Intersector::LIMIT_NEAREST);
    osgUtil::IntersectionVisitor visitor(line);
    visitor.setTraversalMask(mask);
    node.accept(visitor);
    if (!line->containsIntersections()) return false;
    const osgUtil::LineSegmentIntersector::Intersection hit = line->getFirstIntersection();
    surface.point = hit.getWorldIntersectPoint() * toWorld;
    surface.normal = osg::Matrixd::transform3x3(fromWorld, hit.getWorldIntersectNormal());
    if (surface.normal * (above - below) < 0.0) surface.normal = -surface.normal;
    return true;
}

} // namespace

GroundFeet::GroundFeet() = default;
GroundFeet::~GroundFeet() = default;

GroundFeet::GroundFeet(const GroundFeet& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _legs(other._legs), _toLevel(other._toLevel), _floor(other._floor), _leg(other._leg),
      _ground(other._ground), _weight(other._weight) {}

osg::ref_ptr<GroundFeet> GroundFeet::addTo(osg::Node& character) {
    const osg::ref_ptr<ClipCharacter> parts = ClipCharacter::create(character);
    const RestSkeleton rest = readSkeleton(parts->skeleton());
    const JointRoles roles = recogniseJoints(rest);
    const std::map<std::string, osgAnimation::Bone*> bones = bonesBelow(parts->skeleton());
    const auto jointOf = [&](const std::string& role) {
        const int joint = roles.joint(role);
        if (joint < 0)
            throw Error("ground: the character's skeleton has no joint that is known as " + role);
        return joint;
    };
    const auto boneOf = [&](int joint) {
        const std::string& name = rest.joints[static_cast<std::size_t>(joint)].name;
        const auto bone = bones.find(name);
        if (bone == bones.end()) throw Error("ground: no bone \"" + name + "\"");
        return bone->second;
    };
    const osg::ref_ptr<GroundFeet> result = new GroundFeet;
    result->_toLevel = parts->toWorld();
    const auto placeOf = [&](int joint) {
        return toOsg(rest.joints[static_cast<std::size_t>(joint)].centre) * result->_toLevel;
    };

    // The lowest bone that carries all of the figure.
    int top = jointOf("LeftUpperLeg");
    const int head = roles.joint("Head");
    while (top >= 0 && !(rest.isInSubtree(jointOf("RightUpperLeg"), top) &&
                         (head < 0 || rest.isInSubtree(head, top))))
        top = rest.joints[static_cast<std::size_t>(top)].parent;

    std::array<std::array<int, 4>, 2> joints{};
    std::array<RestFoot, 2> feet;
    osg::Vec3d forward;
    result->_leg = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::string name = side == 0 ? "Left" : "Right";
        const int foot = jointOf(name + "Foot"), toes = roles.joint(name + "Toe");
        joints[side] = {jointOf(name + "UpperLeg"), jointOf(name + "LowerLeg"), foot,
                        toes >= 0 && rest.isInSubtree(toes, foot) ? toes : foot};
        const osg::Vec3d knee = placeOf(joints[side][1]);
        feet[side].ankle = feet[side].ball = placeOf(foot);
        result->_leg +=
            0.5 * ((knee - placeOf(joints[side][0])).length() + (feet[side].ankle - knee).length());
        if (toes >= 0) feet[side].ball = placeOf(toes);
        forward += flat(feet[side].ball - feet[side].ankle);
    }
    if (!(forward.normalize() > 0.0)) forward.set(0.0, -1.0, 0.0);
    for (RestFoot& foot : feet) // without toes' joints, in front of the ankle by a fifth of a leg
        if (foot.ball == foot.ankle)
            foot.ball += (forward * 0.2 - osg::Vec3d(0.0, 0.0, 0.06)) * result->_leg;
    measureSoles(*parts, result->_toLevel, forward, result->_leg, feet);
    result->_floor = std::min(feet[0].heel.z(), feet[1].heel.z());

    const osg::Matrixd toRest = osg::Matrixd::inverse(result->_toLevel);
    for (std::size_t side = 0; side < 2; ++side) {
        Leg& leg = result->_legs[side];
        const auto toBone = [&](std::size_t i) {
            return toRest *
                   osg::Matrixd(boneOf(joints[side][i])->getInvBindMatrixInSkeletonSpace());
        };
        for (std::size_t i = 0; i < leg.names.size(); ++i)
            leg.names[i] = boneOf(joints[side][i])->getName();
        const RestFoot& foot = feet[side];
        leg.heel = foot.heel * toBone(2);
        leg.ball = osg::Vec3d(foot.ball.x(), foot.ball.y(), foot.heel.z()) * toBone(2);
        leg.tip = foot.tip * toBone(3);
        leg.knees = osg::Matrixd::transform3x3(forward, toBone(0));
    }
    boneOf(top)->addUpdateCallback(result);
    return result;
}

void GroundFeet::setGround(const Ground& ground) {
    _ground = ground;
    restart();
}

void GroundFeet::setGround(osg::Node* node, osg::Node::NodeMask mask) {
    if (!node) return setGround(Ground());
    const osg::observer_ptr<osg::Node> observed = node;
    setGround([observed, mask](const osg::Vec3d& above, const osg::Vec3d& below, Surface& surface) {
        osg::ref_ptr<osg::Node> locked;
        return observed.lock(locked) && intersect(*locked, mask, above, below, surface);
    });
}

void GroundFeet::setWeight(double weight) {
    if (std::isfinite(weight)) _weight = std::clamp(weight, 0.0, 1.0);
}

void GroundFeet::restart() {
    _onGround = nullptr;
}

bool GroundFeet::findBones(osgAnimation::Bone& top) {
    const auto isThere = [](const auto& bone) { return bone.valid(); };
    if (_top == &top && std::all_of(_legs.begin(), _legs.end(), [&](const Leg& leg) {
            return std::all_of(leg.bones.begin(), leg.bones.end(), isThere);
        }))
        return true;
    const std::map<std::string, osgAnimation::Bone*> bones = bonesBelow(top);
    for (Leg& leg : _legs)
        for (std::size_t i = 0; i < leg.names.size(); ++i) {
            const auto bone = bones.find(leg.names[i]);
            if (bone == bones.end()) return false;
            leg.bones[i] = bone->second;
        }
    _top = &top;
    return true;
}

std::optional<GroundPlane> GroundFeet::findGround(const osg::Vec3d& point) const {
    const double range = kRange * _leg;
    const osg::Vec3d above(point.x(), point.y(), _floor + range);
    const osg::Vec3d below(point.x(), point.y(), _floor - range);
    Surface surface;
    if (!_ground(above * _toWorld, below * _toWorld, surface)) return {};
    const double height = (surface.point * osg::Matrixd::inverse(_toWorld)).z();
    osg::Vec3d normal = osg::Matrixd::transform3x3(_toWorld, surface.normal);
    if (!(std::abs(height - _floor) <= range) || !(normal.normalize() > 0.0) || !normal.valid())
        return {};
    return GroundPlane{{point.x(), point.y(), height}, normal};
}

void GroundFeet::apply(osgAnimation::Bone& top, const osg::Matrixd& toWorld, double dt) {
    std::array<ClipLeg, 2> clip;
    for (std::size_t side = 0; side < 2; ++side) {
        const Leg& leg = _legs[side];
        std::array<osg::Matrixd, 4> places;
        for (std::size_t i = 0; i < places.size(); ++i) {
            places[i] = osg::Matrixd(leg.bones[i]->getMatrixInSkeletonSpace()) * _toLevel;
            if (!places[i].valid()) return restart();
        }
        osg::Vec3d knees = osg::Matrixd::transform3x3(leg.knees, places[0]);
        knees.normalize();
        clip[side] = {places[0].getTrans(),
                      places[1].getTrans(),
                      places[2].getTrans(),
                      knees,
                      {leg.heel * places[2], leg.ball * places[2], leg.tip * places[3]}};
    }
    if (!_onGround) _onGround = std::make_unique<LegsOnGround>(_floor, _leg);
    const osg::Matrixd carried = _toWorld * osg::Matrixd::inverse(toWorld);
    _toWorld = toWorld;
    _onGround->step(clip, dt, carried,
                    [this](const osg::Vec3d& point) { return findGround(point); });

    const osg::Matrixd toSkeleton = osg::Matrixd::inverse(_toLevel);
    const auto turn = [&](osgAnimation::Bone& bone, const osg::Quat& rotation) {
        osg::Vec3d axis(rotation.x(), rotation.y(), rotation.z());
        const double length = axis.length();
        axis = osg::Matrixd::transform3x3(axis, toSkeleton);
        if (axis.normalize() > 0.0)
            rotateBone(bone, osg::Quat(osg::Vec4d(axis * length, rotation.w())));
    };
    osg::Matrixd placed = top.getMatrixInSkeletonSpace();
    placed.postMultTranslate(
        osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, _onGround->lift() * _weight), toSkeleton));
    top.setMatrixInSkeletonSpace(placed);
    rotateBone(top, osg::Quat()); // moves the bones below
    for (std::size_t side = 0; side < 2; ++side) {
        LegsOnGround::Turns turns = _onGround->turns(side);
        for (osg::Quat* rotation : {&turns.thigh, &turns.shin, &turns.foot})
            rotation->slerp(_weight, osg::Quat(), osg::Quat(*rotation));
        turn(*_legs[side].bones[0], turns.thigh); // OSG's product rotates by the left factor first
        turn(*_legs[side].bones[1], turns.thigh.inverse() * turns.shin);
        turn(*_legs[side].bones[2], turns.shin.inverse() * turns.foot);
    }
}

void GroundFeet::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv); // the bones below are posed
    auto* top = dynamic_cast<osgAnimation::Bone*>(node);
    if (!top || !nv || !_ground || !(_weight > 0.0) || !findBones(*top)) return restart();
    osg::NodePath path = nv->getNodePath();
    while (!path.empty() && !dynamic_cast<osgAnimation::Skeleton*>(path.back())) path.pop_back();
    const osg::Matrixd toWorld = osg::Matrixd::inverse(_toLevel) * osg::computeLocalToWorld(path);
    osg::Matrixd fromWorld;
    if (path.empty() || !toWorld.valid() || !fromWorld.invert(toWorld)) return restart();
    const osg::FrameStamp* const stamp = nv->getFrameStamp();
    if (!stamp) restart();
    const double time = stamp ? stamp->getSimulationTime() : 0.0;
    const double dt = time - _time;
    _time = time;
    apply(*top, toWorld, dt);
}

} // namespace osgSkin
