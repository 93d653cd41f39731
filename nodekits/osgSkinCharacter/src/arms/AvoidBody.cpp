// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/AvoidBody>

#include "arms/BodySurface.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace osgSkin {
namespace {

/// Finds the least rotation of one upper arm that moves its forearm and hand out of the body.
///
/// The depth of each of the arm's points in each surface, less its depth at rest, goes through a
/// quadratic hinge. A fixed number of damped Gauss-Newton steps (Levenberg-Marquardt) reduce all
/// these depths, the deepest first. Steps are short and involve no branches: the rotation is a
/// continuous function of the pose.
class ArmTurn {
public:
    /// \param arm must outlive this
    /// \param surfaces of the body, posed at rest now; must outlive this
    /// \param atRest the rest pose
    ArmTurn(const ArmPiece& arm, const std::vector<BodySurface>& surfaces,
            const PosedJoints& atRest);

    /// The rotation about the upper arm's joint, skeleton space; exactly 1 where the arm is free.
    /// \param pose also set on the surfaces
    glm::dquat find(const PosedJoints& pose);

private:
    /// A rotation vector in addition to `turn`; zero where the arm is free.
    glm::dvec3 step(const glm::dquat& turn) const;

    const ArmPiece& _arm;
    const std::vector<BodySurface>& _surfaces;
    double _margin;
    std::vector<double>
        _allowed; ///< [surface * points + point], depth at rest, which is no contact
    std::vector<glm::dvec3>
        _fromJoint; ///< the points before the rotation, relative to the upper arm's joint
    glm::dvec3 _shoulder{0.0};
};

constexpr double kMargin =
    0.01; ///< distance from the skin, in arm lengths, at which rotating begins
constexpr double kLeverage = 0.4; ///< arm lengths; shorter levers get only part of their correction
constexpr int kSteps = 8;

/// A smooth ramp: 0 below 0, slope 1 above `width`.
double hinge(double x, double width) {
    return x >= width ? x - 0.5 * width : 0.5 * x * x / width;
}

double hingeSlope(double x, double width) {
    return std::min(x / width, 1.0);
}

glm::dquat fromVector(const glm::dvec3& rotation) {
    const double angle = glm::length(rotation);
    if (angle < 1e-12) return glm::normalize(glm::dquat(1.0, 0.5 * rotation));
    return {std::cos(0.5 * angle), std::sin(0.5 * angle) / angle * rotation};
}

/// Clamps a rotation vector smoothly, so that all steps together never exceed
/// AvoidBodyReport::kMaxDegrees.
glm::dvec3 limited(const glm::dvec3& step) {
    const double share = glm::length(step) * kSteps / glm::radians(AvoidBodyReport::kMaxDegrees);
    return step / std::sqrt(1.0 + share * share);
}

ArmTurn::ArmTurn(const ArmPiece& arm, const std::vector<BodySurface>& surfaces,
                 const PosedJoints& atRest)
    : _arm(arm), _surfaces(surfaces), _margin(kMargin * arm.length) {
    _allowed.reserve(surfaces.size() * arm.skin.size());
    for (const BodySurface& surface : surfaces)
        for (std::size_t i = 0; i < arm.skin.size(); ++i) {
            const glm::dvec3 place = atRest.place(arm.skin.places[i], arm.skin.joints[i]);
            const double depth =
                surface.isNear(place, _margin) ? surface.depth(place).depth : -_margin;
            _allowed.push_back(std::max(depth, -_margin));
        }
    _fromJoint.resize(arm.skin.size());
}

glm::dvec3 ArmTurn::step(const glm::dquat& turn) const {
    // Each contact requires rotation . gradient = -depth, weighted by its depth.
    glm::dmat3 normal(0.0);
    glm::dvec3 wanted(0.0);
    double weights = 0.0;
    for (std::size_t i = 0; i < _fromJoint.size(); ++i) {
        const glm::dvec3 lever = turn * _fromJoint[i];
        const glm::dvec3 place = _shoulder + lever;
        for (std::size_t s = 0; s < _surfaces.size(); ++s) {
            if (!_surfaces[s].isNear(place, _margin)) continue;
            const BodySurface::Depth at = _surfaces[s].depth(place);
            const double beyond = at.depth - _allowed[s * _fromJoint.size() + i];
            if (!(beyond > 0.0)) continue;
            const double depth = hinge(beyond, _margin) / _arm.length;
            const glm::dvec3 gradient =
                -hingeSlope(beyond, _margin) / _arm.length * glm::cross(lever, at.out);
            const double weight = depth;
            normal += weight * glm::outerProduct(gradient, gradient);
            wanted -= weight * depth * gradient;
            weights += weight;
        }
    }
    if (!(weights > 0.0)) return glm::dvec3(0.0);
    for (int k = 0; k < 3; ++k) normal[k][k] += weights * kLeverage * kLeverage;
    return limited(glm::inverse(normal) * wanted);
}

glm::dquat ArmTurn::find(const PosedJoints& pose) {
    _shoulder = pose.centres[_arm.upper];
    for (std::size_t i = 0; i < _fromJoint.size(); ++i)
        _fromJoint[i] = pose.place(_arm.skin.places[i], _arm.skin.joints[i]) - _shoulder;
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    for (int k = 0; k < kSteps; ++k) {
        const glm::dvec3 further = step(turn);
        if (further == glm::dvec3(0.0)) break; // so are all further ones
        turn = glm::normalize(fromVector(further) * turn);
    }
    return turn;
}

void check(const Clip& clip, const RestSkeleton& rest, const JointRoles& roles,
           const SkinMesh& mesh, const Binding& binding) {
    const std::size_t joints = rest.joints.size();
    const auto isJoint = [joints](std::uint32_t joint) { return joint < joints; };
    if (clip.joints != joints || clip.rotations.size() != clip.frames * joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error("clear hands: expected a clip of the skeleton's " + std::to_string(joints) +
                    " joints, found one of " + std::to_string(clip.joints));
    if (roles.roles.size() != joints)
        throw Error("clear hands: expected roles of the skeleton's joints");
    if (binding.regions.size() != mesh.positions.size() ||
        !std::all_of(binding.regions.begin(), binding.regions.end(), isJoint))
        throw Error("clear hands: expected a binding of the mesh to the skeleton");
}

/// Where a hand passes the middle of a limb, the shortest direction out changes sides: rotations
/// are blended over so many seconds before and after.
constexpr double kBlend = 0.06;

/// The axis times the angle in radians.
glm::dvec3 toVector(const glm::dquat& q) {
    const glm::dvec3 axis = (q.w < 0.0 ? -1.0 : 1.0) * glm::dvec3(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine > 0.0 ? 2.0 * std::atan2(sine, std::abs(q.w)) / sine * axis : axis;
}

/// Blends over time, near samples with more weight; exactly zero where all near samples are.
glm::dvec3 blended(const std::vector<glm::dvec3>& turns, std::size_t frame, double frameTime) {
    const auto reach = static_cast<std::ptrdiff_t>(frameTime > 0.0 ? kBlend / frameTime : 0.0);
    const auto at = static_cast<std::ptrdiff_t>(frame);
    const auto last = static_cast<std::ptrdiff_t>(turns.size()) - 1;
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (auto i = std::max<std::ptrdiff_t>(0, at - reach); i <= std::min(last, at + reach); ++i) {
        const double weight = double(reach + 1 - std::abs(i - at));
        sum += weight * turns[static_cast<std::size_t>(i)];
        weights += weight;
    }
    return sum / weights;
}

PosedJoints restPose(const RestSkeleton& rest) {
    PosedJoints pose;
    for (const RestJoint& joint : rest.joints) pose.rest.push_back(joint.centre);
    pose.rotations.assign(pose.rest.size(), {1.0, 0.0, 0.0, 0.0});
    pose.centres = pose.rest;
    return pose;
}

} // namespace

std::string AvoidBodyReport::text() const {
    std::ostringstream text;
    text.precision(3);
    text << turned << " of " << samples << " samples of arms turned, by " << meanDegrees
         << " degrees in the mean of all, " << largestDegrees << " at most";
    return text.str();
}

AvoidBodyReport avoidBody(Clip& clip, const RestSkeleton& rest, const JointRoles& roles,
                          const SkinMesh& mesh, const Binding& binding) {
    check(clip, rest, roles, mesh, binding);
    AvoidBodyReport result;
    BodyPieces body = findBodyPieces(rest, roles, mesh, binding);
    PosedJoints pose = restPose(rest);
    for (BodySurface& surface : body.surfaces) surface.pose(pose);
    std::vector<ArmTurn> turns;
    turns.reserve(body.arms.size());
    for (const ArmPiece& arm : body.arms) turns.emplace_back(arm, body.surfaces, pose);

    // [arm][sample], in the parent joint's axes
    std::vector<std::vector<glm::dvec3>> found(turns.size(), std::vector<glm::dvec3>(clip.frames));
    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        worldRotations(rest, &clip.rotations[frame * clip.joints], pose.rotations);
        worldPositions(rest, pose.rotations, clip.rootPositions[frame], pose.centres);
        for (BodySurface& surface : body.surfaces) surface.pose(pose);
        for (std::size_t a = 0; a < turns.size(); ++a) {
            const std::size_t upper = body.arms[a].upper;
            const glm::dquat& above =
                pose.rotations[static_cast<std::size_t>(rest.joints[upper].parent)];
            found[a][frame] = glm::conjugate(above) * toVector(turns[a].find(pose));
        }
    }
    for (std::size_t a = 0; a < turns.size(); ++a)
        for (std::size_t frame = 0; frame < clip.frames; ++frame) {
            ++result.samples;
            const glm::dvec3 turn = blended(found[a], frame, clip.frameTime);
            const double angle = glm::length(turn);
            if (!(angle > 0.0)) continue; // leaves the sample unchanged
            glm::dquat& rotation = clip.rotations[frame * clip.joints + body.arms[a].upper];
            rotation = glm::normalize(glm::angleAxis(angle, turn / angle) * rotation);
            ++result.turned;
            result.meanDegrees += glm::degrees(angle);
            result.largestDegrees = std::max(result.largestDegrees, glm::degrees(angle));
        }
    if (result.samples > 0) result.meanDegrees /= double(result.samples);
    return result;
}

} // namespace osgSkin
