// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/RatioFields.h"

#include "joints/BodyAxes.h"
#include "mesh/Parallel.h"
#include "mesh/SkinSmoother.h"
#include "ratios/MinimizeStretch.h"
#include "regions/HermiteRatio.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Directions in which an arm may point: to the front, up and away from the body; of any length.
constexpr double kReached[][3] = {{0.0, -1.0, 0.2}, {0.5, -1.0, 0.2}, {-0.5, -1.0, 0.3},
                                  {1.0, 0.0, 0.0},  {1.0, 0.0, 1.0},  {0.0, 0.0, 1.0},
                                  {1.0, -0.7, 1.0}, {1.0, -0.7, 0.0}, {0.5, 0.7, 1.0},
                                  {1.0, 1.0, 0.4},  {0.0, 0.8, 1.0},  {-0.3, -0.4, 1.0}};

/// Widths of a field above and below its joint, in limb radii, times BindOptions::smoothing.
struct Widths {
    double above, below;
};

/// A limb's joint bends its skin mostly above the joint: the forearm and the calf keep their shape.
constexpr Widths kBetweenLimbs{1.5, 0.75};

/// The same for elbows and knees. This and kAboveHand are captured people's (README.md, "Like
/// captured people").
constexpr Widths kElbowOrKnee{1.1, 0.65};
constexpr Widths kOther{1.0, 1.0};

/// The trunk's joints are so close together that their fields would overlap. Their radius is that
/// of the waist, as the chest's would include the shoulders.
constexpr Widths kSpine{0.6, 0.6};
constexpr Widths kCollar{0.72, 0.72};

/// An arm's skin follows its collar bone wholly. But a raised collar bone as short as a toddler's,
/// in limb radii, would end in a point, so there the skin around the shoulder's joint, down to
/// kFreeBelowShoulder radii below it, is free.
constexpr double kShortCollar = 2.55, kFreeBelowShoulder = 0.4;

/// A rigid part begins close behind its joint, and the skin above takes up more of the rotation.
constexpr Widths kRigid{1.5, 0.6};

/// The width above the border of a head or foot, and of a hand.
constexpr double kAboveBorder = 0.95;
constexpr double kAboveHand = 0.38;

/// A field reaches along a limb no farther than this share of the bone: limbs of game figures may
/// be as short as they are thick.
constexpr double kMaxShareOfBone = 0.6;

/// Widths at a finger's or toe's joint, in lengths of its bone on that side, and above a last one.
constexpr double kDigit = 0.5;
constexpr double kTip = 0.3;

/// A spine runs behind the belly. A plane this much below the joint, in radii, loses less of the
/// belly's volume.
constexpr double kTrunkLift = 0.15;

/// The least share of a joint's rotation that the middle third of its own bone takes, and the
/// largest share that the middle third of the bone above takes.
constexpr double kOwnRigidity = 0.975;
constexpr double kNextRigidity = 0.003;

/// Skin farther from its limb's bone than this, in limb radii, is that of a skirt or a wide sleeve.
constexpr double kFarFromBone = 2.0;

/// The search for widths ends when the excess is within this factor of its limit, or after kTries.
constexpr double kTolerance = 1.1;
constexpr int kTries = 6;

/// The smallest width, as a share of the first. If an arm hangs so low that the armpit reaches into
/// its middle third, no width leaves that third rigid, and a narrow one tears the armpit.
constexpr double kNarrowest = 0.4;

/// When an arm's field is evened out, skin this much farther from the joint than the field reaches
/// may take part.
constexpr double kRoom = 1.2;

/// A field is in transition between this value and 1 minus it.
constexpr double kBetween = 0.02;

/// Upper limit of gradientFactor(): a single needle of the mesh must not spread a field over the
/// body.
constexpr double kMax = 3.0;

/// The width, in limb radii, that makes a field with given boundaries continuous across regions,
/// and what is cut off again, so that the ratios are exact close beyond the boundaries.
constexpr double kBoundedWidth = 0.25;
constexpr double kBoundedCutOff = 0.02;

/// The rotations that take an upper arm from its rest pose to the directions in which arms point:
/// down, forwards, to the side and up. An arm that rests raised mostly turns down.
///
/// \param joints of planJoints()
/// \param joint where a limb leaves the trunk
/// \return axis times angle, radians, rest space; empty if there is no hand below the joint, or
///         the body's orientation is unknown
std::vector<glm::dvec3> armSwings(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const std::optional<BodyAxes> body = bodyAxes(joints);
    if (!body || !carries(joints, joint, JointPart::Hand)) return {};
    glm::dvec3 away = glm::cross(body->up, body->front);
    if (glm::dot(away, joints[joint].centre - joints.front().centre) < 0.0) away = -away;
    std::vector<glm::dvec3> swings;
    for (const auto& [front, up, out] : kReached) {
        const glm::dvec3 to = glm::normalize(front * body->front + up * body->up + out * away);
        const glm::dvec3 axis = glm::cross(joints[joint].boneAxis, to);
        const double sine = glm::length(axis);
        if (sine < 1e-6) continue; // the rest pose
        swings.push_back(std::atan2(sine, glm::dot(joints[joint].boneAxis, to)) / sine * axis);
    }
    return swings;
}

/// The welded vertices around the middle third of a limb's bone, which should move almost rigidly.
std::vector<std::uint32_t> middleThird(const BinaryField& binary, std::size_t joint) {
    const PlannedJoint& bone = binary.joints[joint];
    const std::vector<double> below = binary.divided(joint);
    std::vector<double> beyond(below.size(), 0.0);
    if (bone.child >= 0) beyond = binary.divided(static_cast<std::size_t>(bone.child));
    std::vector<std::uint32_t> third;
    for (std::uint32_t v = 0; v < below.size(); ++v) {
        if (below[v] < 0.5 || beyond[v] >= 0.5) continue;
        const double along =
            glm::dot(binary.mesh.positions[v] - bone.centre, bone.boneAxis) / bone.boneLength;
        if (along >= 1.0 / 3.0 && along <= 2.0 / 3.0) third.push_back(v);
    }
    return third;
}

double meanOf(const std::vector<double>& field, const std::vector<std::uint32_t>& vertices) {
    double sum = 0.0;
    for (const std::uint32_t v : vertices) sum += field[v];
    return sum / static_cast<double>(vertices.size());
}

/// The length of a field's gradient at each vertex, estimated from its edges: averaged over all
/// directions, the squared slope along an edge is half of the squared gradient.
std::vector<double> slopes(const WeldedMesh& mesh, const std::vector<double>& field) {
    std::vector<double> result(field.size(), 0.0);
    for (std::uint32_t v = 0; v < field.size(); ++v) {
        double squares = 0.0, count = 0.0;
        for (const std::uint32_t next : mesh.neighboursOf(v)) {
            const double length = glm::distance(mesh.positions[v], mesh.positions[next]);
            if (!(length > 0.0)) continue;
            const double slope = (field[next] - field[v]) / length;
            squares += slope * slope;
            count += 1.0;
        }
        if (count > 0.0) result[v] = std::sqrt(2.0 * squares / count);
    }
    return result;
}

double slopeBetween(const std::vector<double>& field, const std::vector<double>& slope) {
    double squares = 0.0, count = 0.0;
    for (std::size_t v = 0; v < field.size(); ++v) {
        if (!(field[v] > kBetween && field[v] < 1.0 - kBetween)) continue;
        squares += slope[v] * slope[v];
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// Stretches [cutOff, 1 - cutOff] to [0, 1] and clamps.
void stretch(std::vector<double>& field, double cutOff) {
    for (double& a : field) a = std::clamp((a - cutOff) / (1.0 - 2.0 * cutOff), 0.0, 1.0);
}

/// \param share a factor of the width for each vertex; empty: 1 for all
std::vector<double> spread(const SkinSmoother& smoother, const std::vector<double>& binary,
                           const Widths& widths, const std::vector<double>& share,
                           const std::vector<bool>& isHeld, double cutOff) {
    std::vector<double> width(binary.size());
    for (std::size_t v = 0; v < width.size(); ++v) {
        width[v] = binary[v] < 0.5 ? widths.above : widths.below;
        if (!share.empty()) width[v] *= share[v];
    }
    std::vector<double> field = binary;
    smoother.smooth(field, width, isHeld);
    stretch(field, cutOff);
    return field;
}

/// The field of a head, hand, foot or finger tip: 1 on all its own skin, and falling to 0 over the
/// limb above.
std::vector<double> fromBorder(const SkinSmoother& smoother, const std::vector<double>& own,
                               double width, double cutOff) {
    std::vector<bool> isOwn(own.size());
    for (std::size_t v = 0; v < own.size(); ++v) isOwn[v] = own[v] > 0.5;
    std::vector<double> field = own;
    smoother.smooth(field, std::vector<double>(own.size(), width), isOwn);
    for (double& a : field) a = std::max(0.0, (a - cutOff) / (1.0 - cutOff));
    return field;
}

/// The radius of the waist, the smallest of the spine's; at most `radius`.
double waistRadius(const std::vector<PlannedJoint>& joints, const std::vector<double>& radii,
                   double radius) {
    for (std::size_t j = 1; j < joints.size(); ++j)
        if (joints[j].isSpine() && radii[j] > 0.0) radius = std::min(radius, radii[j]);
    return radius;
}

/// Whether the joint is in the middle of an arm or a leg.
bool isElbowOrKnee(const std::vector<PlannedJoint>& joints, std::size_t index) {
    const std::size_t above = regionAbove(joints, index);
    if (carries(joints, above, JointPart::Head)) return false;
    const auto isLimb = [&joints](std::size_t j) {
        return carries(joints, j, JointPart::Hand) || carries(joints, j, JointPart::Foot);
    };
    std::size_t limbs = 0; // two begin at hips
    for (std::size_t j = above + 1; j < joints.size(); ++j)
        if (joints[j].parent == static_cast<int>(above) && isLimb(j)) ++limbs;
    return limbs == 1 && isLimb(index);
}

/// The first widths to try, in rest units.
/// \param limb whether the joint is a limb's
/// \param onLimb whether the joint above is a limb's
/// \param elbowOrKnee isElbowOrKnee(), if both are limbs'
Widths firstWidths(const std::vector<PlannedJoint>& joints, std::size_t index, bool limb,
                   bool onLimb, bool elbowOrKnee, const std::vector<double>& radii,
                   double smoothing) {
    const PlannedJoint& joint = joints[index];
    const double radius = joint.isSpine() ? waistRadius(joints, radii, radii[index]) : radii[index];
    const auto times = [&](const Widths& widths) {
        return Widths{widths.above * smoothing * radius, widths.below * smoothing * radius};
    };
    if (joint.rigid >= 0) return times(kRigid);
    if (joint.isOfTrunk()) return times(joint.isCollarBone() ? kCollar : kSpine);
    if (joint.isDigit()) {
        const Widths widths = times(kOther);
        return {std::min(widths.above, kDigit * joint.lengthAbove),
                std::min(widths.below, kDigit * joint.boneLength)};
    }
    Widths widths = times(elbowOrKnee ? kElbowOrKnee : limb && onLimb ? kBetweenLimbs : kOther);
    if (carries(joints, index, JointPart::Head))
        return widths; // necks bend over their whole length
    if (onLimb) widths.above = std::min(widths.above, kMaxShareOfBone * joint.lengthAbove);
    if (joint.boneLength > 0.0)
        widths.below = std::min(widths.below, kMaxShareOfBone * joint.boneLength);
    return widths;
}

/// True for the last joint of a finger or toe with several: all skin beyond it is its own.
bool isLastDigit(const std::vector<PlannedJoint>& joints, const PlannedJoint& joint) {
    return joint.isDigit() && joint.child < 0 &&
           joints[static_cast<std::size_t>(joint.parent)].isDigit();
}

/// The skin of a joint and all below it.
std::vector<bool> skinOf(const BinaryField& binary, int joint) {
    const std::vector<bool> isBelow = subtreeOf(binary.joints, static_cast<std::size_t>(joint));
    std::vector<bool> result(binary.regions.size());
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = isBelow[binary.regions[v]];
    return result;
}

/// The skin that follows the collar bone of an arm wholly (kShortCollar).
std::vector<bool> armSkin(const BinaryField& binary, int joint, const std::vector<double>& radii) {
    std::vector<bool> result = skinOf(binary, joint);
    const PlannedJoint& arm = binary.joints[static_cast<std::size_t>(joint)];
    const glm::dvec3 bone = arm.boneEnd - arm.centre;
    const double radius = radii[static_cast<std::size_t>(joint)];
    const double below =
        std::min(2.0 * (kShortCollar * radius - arm.lengthAbove), kFreeBelowShoulder * radius);
    for (std::size_t v = 0; v < result.size(); ++v)
        if (glm::dot(binary.mesh.positions[v] - arm.centre, bone) < below * arm.boneLength)
            result[v] = false;
    return result;
}

/// Narrows a width, down to `least`, if `excess`, the field's value in the middle third, exceeds
/// `most`. At a given distance a field decreases about with the fifth power of its width.
bool narrow(double& width, double least, double excess, double most) {
    if (width <= least || excess <= kTolerance * most) return false;
    width = std::max(least, width * std::max(0.6, std::pow(most / excess, 0.2)));
    return true;
}

/// For each vertex, whether a field is neither 0 nor 1 there.
std::vector<bool> isPartial(const std::vector<double>& field) {
    std::vector<bool> result(field.size());
    for (std::size_t v = 0; v < field.size(); ++v) result[v] = field[v] > 0.0 && field[v] < 1.0;
    return result;
}

/// Evens out the stretch by an arm's swings of the skin between the arm and the trunk.
/// \param third middleThird() of the arm, which keeps its values
/// \param isFree for each vertex, whether it may change
void equalise(const BinaryField& binary, const SkinSmoother& smoother, std::size_t joint,
              const std::vector<std::uint32_t>& third, double width, std::vector<bool> isFree,
              std::vector<double>& field) {
    const std::vector<glm::dvec3> swings = armSwings(binary.joints, joint);
    if (swings.empty()) return;
    for (const std::uint32_t v : third) isFree[v] = false;
    pinUnanchoredPatches(smoother.skin(), field, isFree);
    const glm::dvec3& centre = binary.joints[joint].centre;
    smoother.change(field, isFree, width,
                    [&](const HeatGraph& skin, std::vector<double>& coarse,
                        const std::vector<bool>& coarseFree) {
                        minimizeStretch(skin, coarse, coarseFree, centre, swings);
                    });
}

/// Widens the spread on skin far from the bone of its limb, so that a skirt is not torn between the
/// legs: in proportion to the distance where limbs leave the trunk, else to what other limbs have.
/// \param[in,out] share a factor of the width for each vertex; empty: 1 for all
void widenFarSkin(const BinaryField& binary, const std::vector<double>& radii, bool atTrunk,
                  std::vector<double>& share) {
    for (std::size_t v = 0; v < binary.regions.size(); ++v) {
        const std::uint32_t joint = binary.regions[v];
        const PlannedJoint& bone = binary.joints[joint];
        if (bone.isOfTrunk() || bone.rigid >= 0 || !(radii[joint] > 0.0)) continue;
        const double far = distanceToBone(bone, binary.mesh.positions[v]) / radii[joint];
        if (far <= kFarFromBone) continue;
        if (share.empty()) share.assign(binary.regions.size(), 1.0);
        share[v] *= atTrunk ? std::min(far, kMax) : kBetweenLimbs.above / kElbowOrKnee.above;
    }
}

/// Ends a limb's field within its own bone and the bone above. For a mesh so coarse that the bone
/// has no vertices in its middle: heat flows from one ring of vertices to the next.
void endWithinBones(const BinaryField& binary, std::size_t joint, bool onLimb,
                    std::vector<double>& field) {
    const PlannedJoint& bone = binary.joints[joint];
    const std::vector<bool> isBelow = skinOf(binary, static_cast<int>(joint));
    const auto share = [](double along) {
        return hermiteRatio((along - kMaxShareOfBone) / (1.0 - kMaxShareOfBone));
    };
    for (std::size_t v = 0; v < field.size(); ++v) {
        const glm::dvec3 d = binary.mesh.positions[v] - bone.centre;
        if (isBelow[v])
            field[v] = std::max(field[v], share(glm::dot(d, bone.boneAxis) / bone.boneLength));
        else if (onLimb)
            field[v] =
                std::min(field[v], 1.0 - share(-glm::dot(d, bone.comingFrom) / bone.lengthAbove));
    }
}

/// The field of a hand, a foot or a head, whose border is narrowed until the skin around the middle
/// of the bone above stays rigid.
std::vector<double> extremityBend(const SkinSmoother& smoother, const std::vector<double>& start,
                                  const std::vector<std::uint32_t>& above, double width,
                                  double cutOff) {
    const double least = kNarrowest * width;
    std::vector<double> field = fromBorder(smoother, start, width, cutOff);
    for (int i = 0;
         i < kTries && !above.empty() && narrow(width, least, meanOf(field, above), kNextRigidity);
         ++i)
        field = fromBorder(smoother, start, width, cutOff);
    return field;
}

/// Spreads a limb's field, and narrows the widths until the skin around the middles of its own bone
/// and of the one above stays rigid.
std::vector<double> limbBend(const SkinSmoother& smoother, const std::vector<double>& start,
                             const std::vector<double>& share, const std::vector<bool>& isHeld,
                             const std::vector<std::uint32_t>& own,
                             const std::vector<std::uint32_t>& above, double cutOff,
                             Widths& widths) {
    const Widths least = {kNarrowest * widths.above, kNarrowest * widths.below};
    std::vector<double> field;
    for (int i = 0; i < kTries; ++i) {
        field = spread(smoother, start, widths, share, isHeld, cutOff);
        bool narrower = false;
        if (!own.empty())
            narrower =
                narrow(widths.below, least.below, 1.0 - meanOf(field, own), 1.0 - kOwnRigidity);
        if (!above.empty())
            narrower =
                narrow(widths.above, least.above, meanOf(field, above), kNextRigidity) || narrower;
        if (!narrower) break;
    }
    return field;
}

/// A joint's bend field if the author gave no boundaries: its binary field
/// (BinaryField::divided()), spread over the skin about as far as the limb is thick, and exactly 0
/// and 1 beyond that.
///
/// A limb's field is made narrow enough that the middle thirds of its bone and of the bone above
/// stay rigid; a wide field on a thick short bone would look like rubber. On the trunk's side of a
/// shoulder or hip there is no such limit, so each side has its own width. If such a limb leaves
/// the trunk, the field is spread farther where it would be steepest, as in the armpit
/// (gradientFactor()); an arm's is then redistributed for the directions in which arms swing
/// (minimizeStretch()).
std::vector<double> smoothBend(const BinaryField& binary, const SkinSmoother& smoother,
                               std::size_t joint, const std::vector<double>& radii,
                               const BindOptions& options) {
    const PlannedJoint& planned = binary.joints[joint];
    const double radius = radii[joint];
    const bool isLifted = planned.isSpine();
    std::vector<double> start = binary.divided(joint, isLifted ? -kTrunkLift * radius : 0.0);
    if (!(radius > 0.0)) return start;
    if (isLastDigit(binary.joints, planned))
        return fromBorder(smoother, start,
                          std::min(options.smoothing * radius, kTip * planned.lengthAbove),
                          options.cutOff);

    const std::size_t above = regionAbove(binary.joints, joint);
    const bool limb = isLimb(planned, radius);
    const bool onLimb = above > 0 && isLimb(binary.joints[above], radii[above]);
    std::vector<std::uint32_t> own, previous;
    if (limb) own = middleThird(binary, joint);
    if (onLimb) previous = middleThird(binary, above);
    if (!planned.beyond.empty()) {
        const double border = planned.part == JointPart::Hand ? kAboveHand : kAboveBorder;
        return extremityBend(smoother, start, previous, border * options.smoothing * radius,
                             options.cutOff);
    }
    const bool elbowOrKnee = limb && onLimb && isElbowOrKnee(binary.joints, joint);
    Widths widths =
        firstWidths(binary.joints, joint, limb, onLimb, elbowOrKnee, radii, options.smoothing);
    const std::vector<bool> isHeld =
        planned.isCollarBone() ? armSkin(binary, planned.child, radii) : std::vector<bool>();
    std::vector<double> share;
    if (limb && binary.joints[above].isOfTrunk())
        share = gradientFactor(binary.mesh,
                               spread(smoother, start, widths, {}, isHeld, options.cutOff));
    const bool leavesTrunk = !share.empty();
    const bool atTrunk = binary.joints[above].isOfTrunk();
    if (atTrunk || elbowOrKnee) widenFarSkin(binary, radii, atTrunk, share);
    std::vector<double> field =
        limbBend(smoother, start, share, isHeld, own, previous, options.cutOff, widths);
    if (leavesTrunk) {
        const Widths wider = {kRoom * widths.above, kRoom * widths.below};
        const std::vector<bool> isFree =
            isPartial(spread(smoother, start, wider, share, isHeld, options.cutOff));
        equalise(binary, smoother, joint, own, options.smoothing * radius, isFree, field);
    }
    const bool isArmOrLeg = !planned.isOfTrunk() && planned.rigid < 0 && !planned.isDigit() &&
                            planned.boneLength > radius &&
                            !carries(binary.joints, joint, JointPart::Head);
    if (isArmOrLeg && middleThird(binary, joint).empty())
        endWithinBones(binary, joint,
                       above > 0 && !binary.joints[above].isOfTrunk() && planned.lengthAbove > 0.0,
                       field);
    return field;
}

bool hasBoundaries(const PlannedJoint& joint) {
    return joint.options.bendUpper || joint.options.bendLower;
}

/// The bend field between boundaries that the author gave, of which one may be missing.
std::vector<double> boundedField(const BinaryField& binary, const SkinSmoother& smoother,
                                 std::size_t joint, double radius, double smoothing) {
    const PlannedJoint& planned = binary.joints[joint];
    const double reach = smoothing * radius / std::max(planned.boneLength, 1e-9 * binary.mesh.size);
    const double upper = planned.options.bendUpper.value_or(
        std::min(-reach, planned.options.bendLower.value_or(reach) - reach));
    const double lower = planned.options.bendLower.value_or(std::max(reach, upper + reach));
    std::vector<double> field = binary.bounded(joint, upper, lower);
    smoother.smooth(field, kBoundedWidth * radius);
    stretch(field, kBoundedCutOff);
    return field;
}

} // namespace

std::vector<double> gradientFactor(const WeldedMesh& mesh, const std::vector<double>& field) {
    const std::vector<double> slope = slopes(mesh, field);
    const double between = slopeBetween(field, slope);
    std::vector<double> share(field.size(), 1.0);
    if (!(between > 0.0)) return share;
    for (std::uint32_t v = 0; v < share.size(); ++v) {
        double sum = slope[v], count = 1.0;
        for (const std::uint32_t next : mesh.neighboursOf(v)) {
            sum += slope[next];
            count += 1.0;
        }
        share[v] = std::clamp(sum / (count * between), 1.0, kMax);
    }
    return share;
}

JointFields bendFields(const BinaryField& binary, const std::vector<double>& radii,
                       const BindOptions& options, const RestSkeleton& skeleton,
                       const Progress& progress) {
    const std::vector<PlannedJoint>& joints = binary.joints;
    const double widest = options.smoothing * *std::max_element(radii.begin(), radii.end());
    const SkinSmoother smoother(binary.mesh, widest);
    std::vector<std::size_t> bent;
    for (std::size_t j = 1; j < joints.size(); ++j)
        if (joints[j].holdsRegion()) bent.push_back(j);
    JointFields fields(joints.size(), binary.mesh.vertexCount());
    fields.set(0, std::vector<double>(binary.mesh.vertexCount(), 1.0));
    SharedProgress shared(bent.size());
    Progress tell;
    std::size_t told = 0;
    if (progress) // joints finish in any order, but all runs report the same steps
        tell = [&](const ProgressStep& step) {
            progress({"bend of " + skeleton.joints[bent[told++]].name, step.fraction});
        };
    shared.tellWhile(tell, [&] {
        parallelFor(bent.size(), [&](std::size_t i) {
            const std::size_t j = bent[i];
            fields.set(j, hasBoundaries(joints[j])
                              ? boundedField(binary, smoother, j, radii[j], options.smoothing)
                              : smoothBend(binary, smoother, j, radii, options));
            shared.done({});
        });
    });
    for (const std::size_t j : bent) {
        if (!joints[j].isDigit() || !joints[regionAbove(joints, j)].isExtremity()) continue;
        // A finger moves no skin that its hand does not move.
        std::vector<double> field = fields.values(j);
        const std::vector<double> hand = fields.values(regionAbove(joints, j));
        for (std::size_t v = 0; v < field.size(); ++v) field[v] = std::min(field[v], hand[v]);
        fields.set(j, field);
    }
    raiseParents(joints, fields);
    return fields;
}

} // namespace osgSkin
