// SPDX-License-Identifier: MIT
#include <osgSkinMotion/FootPlacement>

#include "bones/BoneCallbacks.h"
#include "bones/Figure.h"
#include "bones/TwoBone.h"
#include "feet/Legs.h"
#include "ground/LegsOnGround.h"

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
#include <utility>

namespace osgSkin {
namespace {

constexpr double kRange = 0.6; ///< leg lengths above and below the clips' floor

bool intersect(osg::Node& node, osg::Node::NodeMask mask, const osg::Vec3d& above,
               const osg::Vec3d& below, FootPlacement::Surface& surface) {
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

FootPlacement::FootPlacement() = default;
FootPlacement::~FootPlacement() = default;

FootPlacement::FootPlacement(const FootPlacement& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _topName(other._topName), _legs(other._legs), _toLevel(other._toLevel), _floor(other._floor),
      _leg(other._leg), _ground(other._ground), _weight(other._weight) {}

osg::ref_ptr<FootPlacement> FootPlacement::create(osg::Node& root) {
    const Figure figure = findFigure(root, "foot placement");
    const osg::ref_ptr<ClipCharacter> parts = ClipCharacter::create(root);
    const RestSkeleton rest = readSkeleton(parts->skeleton());
    const JointRoles roles = recogniseJoints(rest);
    const std::map<std::string, osgAnimation::Bone*> bones = bonesBelow(parts->skeleton());
    const auto boneOf = [&](std::size_t joint) {
        const std::string& name = rest.joints[joint].name;
        const auto bone = bones.find(name);
        if (bone == bones.end()) figure.fail("no bone \"" + name + '"');
        return bone->second;
    };
    const osg::ref_ptr<FootPlacement> result = new FootPlacement;
    result->_toLevel = parts->toWorld();
    RestLegs legs = findLegs(rest, roles, toGlm(result->_toLevel), {},
                             "foot placement: \"" + root.getName() + '"');
    measureSoles(*parts, toGlm(result->_toLevel), legs);
    result->_leg = legs.length;
    result->_floor = std::min(legs.sides[0].heel.z, legs.sides[1].heel.z);
    const glm::dmat4 toRest = glm::inverse(toGlm(result->_toLevel));
    for (std::size_t side = 0; side < 2; ++side) {
        const RestLeg& at = legs.sides[side];
        const std::array<std::size_t, 4> joints = {at.hip, at.knee, at.ankle, at.toe};
        std::array<glm::dmat4, 4> toBone{};
        Leg& leg = result->_legs[side];
        for (std::size_t i = 0; i < joints.size(); ++i) {
            leg.names[i] = rest.joints[joints[i]].name;
            toBone[i] =
                toGlm(osg::Matrixd(boneOf(joints[i])->getInvBindMatrixInSkeletonSpace())) * toRest;
        }
        leg.heel = toOsg(transformPoint(toBone[2], at.heel));
        leg.ball = toOsg(transformPoint(toBone[2], {at.ball.x, at.ball.y, at.heel.z}));
        leg.tip = toOsg(transformPoint(toBone[3], at.tip));
        leg.knees = toOsg(transformDirection(toBone[0], legs.forward));
    }
    // The lowest bone that carries all of the figure.
    int top = static_cast<int>(legs.sides[0].hip);
    const int head = roles.joint("Head");
    while (top >= 0 && !(rest.isInSubtree(static_cast<int>(legs.sides[1].hip), top) &&
                         (head < 0 || rest.isInSubtree(head, top))))
        top = rest.joints[static_cast<std::size_t>(top)].parent;
    result->_topName = boneOf(static_cast<std::size_t>(top))->getName();
    return result;
}

osg::Node& FootPlacement::nodeFor(osg::Node& root) const {
    const Figure figure = findFigure(root, "foot placement");
    const std::map<std::string, osgAnimation::Bone*> bones = bonesBelow(*figure.skeleton);
    const auto top = bones.find(_topName);
    if (top == bones.end()) figure.fail("no bone \"" + _topName + '"');
    return *top->second;
}

void FootPlacement::setGround(const Ground& ground) {
    if (_ground) restart(); // else go on as a file says
    _ground = ground;
}

void FootPlacement::setGround(osg::Node* node, osg::Node::NodeMask mask) {
    if (!node) return setGround(Ground());
    const osg::observer_ptr<osg::Node> observed = node;
    setGround([observed, mask](const osg::Vec3d& above, const osg::Vec3d& below, Surface& surface) {
        osg::ref_ptr<osg::Node> locked;
        return observed.lock(locked) && intersect(*locked, mask, above, below, surface);
    });
}

void FootPlacement::setWeight(double weight) {
    if (std::isfinite(weight)) _weight = std::clamp(weight, 0.0, 1.0);
}

void FootPlacement::restart() {
    _onGround = nullptr;
    _isRead = false;
}

bool FootPlacement::findBones(osgAnimation::Bone& top) {
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

std::optional<GroundPlane> FootPlacement::findGround(const osg::Vec3d& point) const {
    const double range = kRange * _leg;
    const osg::Vec3d above(point.x(), point.y(), _floor + range);
    const osg::Vec3d below(point.x(), point.y(), _floor - range);
    Surface surface;
    if (!_ground(above * _toWorld, below * _toWorld, surface)) return {};
    const double height = (surface.point * osg::Matrixd::inverse(_toWorld)).z();
    osg::Vec3d normal = osg::Matrixd::transform3x3(_toWorld, surface.normal);
    if (!(std::abs(height - _floor) <= range) || !(normal.normalize() > 0.0) || !normal.valid())
        return {};
    return GroundPlane{{point.x(), point.y(), height}, toGlm(normal)};
}

void FootPlacement::apply(osgAnimation::Bone& top, const osg::Matrixd& toWorld, double dt) {
    const glm::dmat4 toLevel = toGlm(_toLevel);
    std::array<ClipLeg, 2> clip;
    for (std::size_t side = 0; side < 2; ++side) {
        const Leg& leg = _legs[side];
        std::array<glm::dmat4, 4> places{};
        for (std::size_t i = 0; i < places.size(); ++i) {
            const osg::Matrixd place = leg.bones[i]->getMatrixInSkeletonSpace();
            if (!place.valid()) return restart();
            places[i] = toLevel * toGlm(place);
        }
        clip[side] = {glm::dvec3(places[0][3]),
                      glm::dvec3(places[1][3]),
                      glm::dvec3(places[2][3]),
                      unitOrZero(transformDirection(places[0], toGlm(leg.knees))),
                      {transformPoint(places[2], toGlm(leg.heel)),
                       transformPoint(places[2], toGlm(leg.ball)),
                       transformPoint(places[3], toGlm(leg.tip))}};
    }
    if (!_onGround) _onGround = std::make_unique<LegsOnGround>(_floor, _leg);
    const glm::dmat4 carried = toGlm(_toWorld * osg::Matrixd::inverse(toWorld));
    _toWorld = toWorld;
    if (!std::exchange(_isRead, false)) // else the pose of the file comes first
        _onGround->step(clip, dt, carried,
                        [this](const glm::dvec3& point) { return findGround(toOsg(point)); });

    const glm::dmat4 toSkeleton = glm::inverse(toLevel);
    const auto turn = [&](osgAnimation::Bone& bone, const glm::dquat& rotation) {
        const glm::dvec3 axis(rotation.x, rotation.y, rotation.z);
        const glm::dvec3 inSkeleton =
            unitOrZero(transformDirection(toSkeleton, axis)) * glm::length(axis);
        rotateBone(bone, toOsg(glm::dquat(rotation.w, inSkeleton)));
    };
    const glm::dvec3 up = transformDirection(toSkeleton, {0.0, 0.0, _onGround->lift() * _weight});
    osg::Matrixd placed = top.getMatrixInSkeletonSpace();
    placed.postMultTranslate(toOsg(up));
    top.setMatrixInSkeletonSpace(placed);
    rotateBone(top, osg::Quat()); // moves the bones below
    for (std::size_t side = 0; side < 2; ++side) {
        LegsOnGround::Turns turns = _onGround->turns(side);
        for (glm::dquat* rotation : {&turns.thigh, &turns.shin, &turns.foot})
            *rotation = glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), *rotation, _weight);
        turn(*_legs[side].bones[0], turns.thigh);
        turn(*_legs[side].bones[1], turns.shin * glm::conjugate(turns.thigh));
        turn(*_legs[side].bones[2], turns.foot * glm::conjugate(turns.shin));
    }
}

void FootPlacement::operator()(osg::Node* node, osg::NodeVisitor* nv) {
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
