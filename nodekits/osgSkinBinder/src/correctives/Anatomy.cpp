// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/Anatomy.h"

#include "joints/BodyAxes.h"
#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// A place on a limb that bends like a hinge.
struct LimbPlace {
    double height;       ///< by which the skin moves outwards at a bend of 90 degrees, limb radii
    double along;        ///< from the joint, limb radii; negative on the limb above
    double around;       ///< degrees: 0 on the flexed side, 90 on the side away from the body
    double width, angle; ///< standard deviations of a Gaussian along and around the limb
};

/// A place around a joint at the trunk, in the body's axes.
struct TrunkPlace {
    double height;
    double outwards, up, front; ///< from the joint, limb radii
    double width;
};

/// Places were read from maps of where captured people's skin differs from a skin without tissue,
/// and heights tried one by one, on FAUST's subjects 0 to 4 and on 36 poses of another man, SCAPE:
/// what comes nearer to one and farther from the other is not here. Rounded to two digits. Both
/// data sets are for research: nothing of them is here but these numbers.
///
/// The knee: the thigh stays full a limb's width above the kneecap, where the quadriceps' tendon
/// runs straight over the joint; outside, just below the kneecap, the skin sinks in.
constexpr LimbPlace kKneeTissue[] = {{0.35, -1.3, 180.0, 0.5, 50.0},
                                     {-0.06, 0.3, 125.0, 0.4, 35.0}};

/// The elbow: the crease is shallow, and below it the forearm's flexors bulge.
constexpr LimbPlace kElbowTissue[] = {{0.16, 0.2, 10.0, 0.7, 35.0}, {0.2, 1.3, 0.0, 0.6, 50.0}};

/// The shoulder. Forward: the pectoral muscle is pushed together. Across: the deltoid's front
/// bulges.
constexpr TrunkPlace kArmForward[] = {{0.8, -1.3, -0.63, 0.95, 0.8}};
constexpr TrunkPlace kArmAcross[] = {{0.5, 0.32, 0.2, 1.1, 0.8}};

/// The hip, thigh forward: the upper, outer buttock stays full over the pelvis and the thigh bone's
/// head.
constexpr TrunkPlace kThighForward[] = {{0.35, 0.7, 0.6, -0.8, 0.7}};

/// The neck, nodding forward: the muscles at both sides are slack. The head's own joint nods as
/// much again.
constexpr TrunkPlace kNod[] = {{-0.5, 1.0, 0.2, -0.3, 0.7}, {-0.5, -1.0, 0.2, -0.3, 0.7}};

/// Bends count up to this many right angles.
constexpr double kMaxBend = 1.5;

/// Distance from the joint, in limb radii, from which on tissue fades out.
constexpr double kWholeTissue = 1.7;

/// Of the posed displacement; with a third one captured people are farther again.
constexpr int kSmoothings = 2;

/// Lengths of bones, in radii, between which limbs become a person's.
constexpr double kStubby = 3.0, kSlender = 5.0;

double gaussian(double x, double width) {
    return std::exp(-0.5 * x * x / (width * width));
}

/// Grows with the bend, in right angles, up to kMaxBend.
double tensionOf(double rightAngles) {
    return std::pow(glm::clamp(rightAngles, 0.0, kMaxBend), 1.5);
}

/// The axes of one side of a body.
struct SideAxes {
    glm::dvec3 outwards, up, front;
    double side; ///< 1 on the left, -1 on the right
};

std::optional<SideAxes> sideAxes(const std::vector<PlannedJoint>& joints,
                                 const ShapedJoint& shaped) {
    const std::optional<BodyAxes> body = bodyAxes(joints);
    if (!body) return std::nullopt;
    const glm::dvec3 left = glm::cross(body->up, body->front);
    const double side = glm::dot(shaped.centre - joints[0].centre, left) < 0.0 ? -1.0 : 1.0;
    return SideAxes{side * left, body->up, body->front, side};
}

/// How much of a joint's tissue a limb has.
double slenderness(double length, double radius) {
    return hermiteRatio((length / radius - kStubby) / (kSlender - kStubby));
}

using Amount = std::function<double(const BendTwist&)>;
using Moves = std::vector<glm::dvec3>;

/// Adds one tissue that moves skin along its normal.
/// \param heightAt of a welded vertex at full tension, rest units
template <typename HeightAt>
void add(const WeldedMesh& mesh, const SkinLayers* layers, Amount amount, const HeightAt& heightAt,
         ShapedJoint& shaped) {
    Moves moves(mesh.vertexCount(), glm::dvec3(0.0));
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        const glm::dvec3 from = mesh.positions[v] - shaped.centre;
        const double radii = glm::length(from) / shaped.radius;
        if (radii >= ShapedJoint::kTissueReach) continue;
        moves[v] = (1.0 - hermiteRatio((radii - kWholeTissue) /
                                       (ShapedJoint::kTissueReach - kWholeTissue))) *
                   heightAt(from) * mesh.normals[v];
    }
    if (layers) layers->follow(moves);
    ShapedJoint::Tissue tissue{std::move(amount), {}};
    for (const ShapedJoint::Vertex& vertex : shaped.vertices)
        tissue.moves.push_back(moves[vertex.index]);
    shaped.tissues.push_back(std::move(tissue));
}

template <std::size_t N>
void addToLimb(const LimbPlace (&places)[N], const SideAxes& side, const WeldedMesh& mesh,
               const SkinLayers* layers, double share, ShapedJoint& shaped) {
    const glm::dvec3 inner = glm::normalize(glm::cross(shaped.functions.axis, shaped.bone));
    glm::dvec3 aside = glm::cross(shaped.bone, inner);
    if (glm::dot(aside, side.outwards) < 0.0) aside = -aside;
    const auto heightAt = [&](const glm::dvec3& from) {
        const bool below = glm::dot(from, shaped.above + shaped.bone) > 0.0;
        const double along = glm::dot(from, below ? shaped.bone : shaped.above) / shaped.radius;
        const double around =
            glm::degrees(std::atan2(glm::dot(from, aside), glm::dot(from, inner)));
        double height = 0.0;
        for (const LimbPlace& place : places) {
            const double away = std::remainder(around - place.around, 360.0);
            height += place.height * gaussian(along - place.along, place.width) *
                      gaussian(away, place.angle);
        }
        return share * shaped.radius * height;
    };
    const auto bentBy = [above = shaped.above, bone = shaped.bone,
                         twistAxis = shaped.twistAxis](const BendTwist& bend) {
        const auto angle = [&above](const glm::dvec3& to) {
            return std::atan2(glm::length(glm::cross(above, to)), glm::dot(above, to));
        };
        const glm::dvec3 posed = partialRotation(bend, twistAxis, 1.0, 1.0) * bone;
        return tensionOf((angle(posed) - angle(bone)) / glm::half_pi<double>());
    };
    add(mesh, layers, bentBy, heightAt, shaped);
}

template <std::size_t N>
void addToTrunk(const TrunkPlace (&places)[N], const SideAxes& side, const WeldedMesh& mesh,
                const SkinLayers* layers, double share, Amount amount, ShapedJoint& shaped) {
    add(
        mesh, layers, std::move(amount),
        [&](const glm::dvec3& from) {
            double height = 0.0;
            for (const TrunkPlace& place : places) {
                const glm::dvec3 at =
                    place.outwards * side.outwards + place.up * side.up + place.front * side.front;
                height +=
                    place.height * gaussian(glm::distance(from / shaped.radius, at), place.width);
            }
            return share * shaped.radius * height;
        },
        shaped);
}

enum class Raised { Forward, Across };

/// How far an arm or a thigh is raised forward or across the body: a part of a rotation vector, in
/// right angles. It counts from the hanging limb.
double raised(const glm::dquat& swing, const glm::dvec3& bone, const SideAxes& side, Raised how) {
    const glm::dquat q = swing * glm::dquat(-side.up, bone);
    const glm::dvec3 sine(q.x, q.y, q.z);
    const double length = glm::length(sine);
    if (!(length > 0.0)) return 0.0;
    const glm::dvec3 turn =
        2.0 * std::atan2(length, q.w) / (length * glm::half_pi<double>()) * sine;
    return -side.side * glm::dot(turn, how == Raised::Forward ? side.outwards : side.up);
}

template <std::size_t N>
void addRaised(const TrunkPlace (&places)[N], Raised how, const SideAxes& side,
               const WeldedMesh& mesh, const SkinLayers* layers, double share,
               ShapedJoint& shaped) {
    const auto amount = [side, how, bone = shaped.bone,
                         twistAxis = shaped.twistAxis](const BendTwist& bend) {
        const double now = raised(partialRotation(bend, twistAxis, 1.0, 0.0), bone, side, how);
        const double atRest = raised(glm::dquat(1.0, 0.0, 0.0, 0.0), bone, side, how);
        return tensionOf(now) - tensionOf(atRest);
    };
    addToTrunk(places, side, mesh, layers, share, amount, shaped);
}

void addToNeck(const SideAxes& side, const WeldedMesh& mesh, const SkinLayers* layers,
               ShapedJoint& shaped) {
    const auto nod = [left = side.side * side.outwards,
                      twistAxis = shaped.twistAxis](const BendTwist& bend) {
        return glm::clamp(bend.bendAngle * glm::dot(bend.bendAxis, left) / glm::half_pi<double>(),
                          -kMaxBend, kMaxBend);
    };
    addToTrunk(kNod, side, mesh, layers, 1.0, nod, shaped);
}

bool isRole(const JointRoles& roles, std::size_t joint, const std::string& role) {
    return roles.roles[joint] == role || roles.roles[joint] == "Left" + role ||
           roles.roles[joint] == "Right" + role;
}

} // namespace

void addTissues(const JointRoles& roles, const std::vector<PlannedJoint>& joints,
                const WeldedMesh& mesh, const SkinLayers* layers, ShapedJoint& shaped) {
    if (!roles.known() || roles.family == kInferredFromGeometry) return;
    const std::optional<SideAxes> side = sideAxes(joints, shaped);
    if (!side) return;
    const std::size_t joint = shaped.functions.joint;
    const PlannedJoint& planned = joints[joint];
    if (shaped.isSoft) {
        if (isRole(roles, joint, "Neck")) addToNeck(*side, mesh, layers, shaped);
        return;
    }
    const double share = slenderness(
        shaped.isAtTrunk() ? planned.boneLength : std::min(planned.boneLength, planned.lengthAbove),
        shaped.radius);
    if (!(share > 0.0)) return;
    if (shaped.isAtTrunk()) {
        if (isRole(roles, joint, "UpperArm")) {
            addRaised(kArmForward, Raised::Forward, *side, mesh, layers, share, shaped);
            addRaised(kArmAcross, Raised::Across, *side, mesh, layers, share, shaped);
        } else if (isRole(roles, joint, "UpperLeg")) {
            addRaised(kThighForward, Raised::Forward, *side, mesh, layers, share, shaped);
        }
    } else if (glm::length(shaped.hinge) > 0.0) {
        if (isRole(roles, joint, "LowerLeg"))
            addToLimb(kKneeTissue, *side, mesh, layers, share, shaped);
        else if (isRole(roles, joint, "LowerArm"))
            addToLimb(kElbowTissue, *side, mesh, layers, share, shaped);
    }
}

Moves displacedByTissues(const ShapedJoint& joint, Moves skin, const BendTwist& bend,
                         const SkinRelaxation& relaxation) {
    if (joint.tissues.empty()) return skin;
    const std::vector<glm::dquat> turns = joint.turnsOf(bend);
    Moves moves(skin.size(), glm::dvec3(0.0));
    for (const ShapedJoint::Tissue& tissue : joint.tissues) {
        const double amount = tissue.amount(bend);
        for (std::size_t i = 0; i < skin.size(); ++i) moves[i] += amount * tissue.moves[i];
    }
    for (std::size_t i = 0; i < skin.size(); ++i) moves[i] = turns[i] * moves[i];
    for (int i = 0; i < kSmoothings; ++i) moves = relaxation.smoothed(std::move(moves));
    for (std::size_t i = 0; i < skin.size(); ++i)
        skin[i] += joint.vertices[i].fade * (glm::conjugate(turns[i]) * moves[i]);
    return skin;
}

} // namespace osgSkin
