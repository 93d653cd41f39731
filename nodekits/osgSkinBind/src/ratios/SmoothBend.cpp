// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/SmoothBend.h"

#include "joints/BodyAxes.h"
#include "limbs/ArmSwings.h"
#include "limbs/HermiteRatio.h"
#include "limbs/LimbRadius.h"
#include "limbs/MiddleThird.h"
#include "ratios/EvenStretch.h"
#include "ratios/HeldSkin.h"
#include "ratios/SlopeShare.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Widths of a field above and below its joint, in limb radii, times BindOptions::smoothing.
struct Widths {
    double above, below;
};

/// A limb's joint bends its skin mostly above the joint: the forearm and the calf keep their shape.
constexpr Widths kBetweenLimbs{1.5, 0.75};
constexpr Widths kOther{1.0, 1.0};

/// The trunk's joints stand so close that their fields would overlap. Their radius is that of the
/// waist: the chest's is measured with the shoulders.
constexpr Widths kSpine{0.6, 0.6};
constexpr Widths kCollar{0.72, 0.72};

/// A rigid part starts close behind its joint, and the skin above takes up more of the rotation.
constexpr Widths kRigid{1.5, 0.6};

/// Above the border of a head, hand or foot.
constexpr double kAboveBorder = 0.95;

/// A field reaches along a limb no farther than this share of the bone: limbs of game figures may
/// be as short as they are thick.
constexpr double kMaxShareOfBone = 0.6;

/// Widths at a finger's or toe's joint, in lengths of its bone on that side, and above a last one.
constexpr double kDigit = 0.5;
constexpr double kTip = 0.3;

/// A spine runs behind the belly. A plane this much below the joint, in radii, loses less of the
/// belly's volume.
constexpr double kTrunkLift = 0.15;

/// What of a joint's rotation the middle third of its own bone must take, and that of the bone
/// above may.
constexpr double kOwnRigidity = 0.975;
constexpr double kNextRigidity = 0.003;

/// How far a figure may miss its limit for the search to end, and how often the search tries.
constexpr double kTolerance = 1.1;
constexpr int kTries = 6;

/// The least that a width may be narrowed to. Where an arm hangs so low that the armpit reaches
/// into its middle third, no width leaves that third rigid, and a narrow one tears the armpit.
constexpr double kNarrowest = 0.4;

/// Where arms swing, skin may take part that lies this much farther from the joint than the field
/// reaches.
constexpr double kRoom = 1.2;

/// \param share of the width that a vertex takes, for each; none where all take 1
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

/// The field of a head, hand or foot, or a finger's tip: 1 on all that is its own, and from there
/// on falling to 0 over the limb above.
std::vector<double> fromBorder(const SkinSmoother& smoother, const std::vector<double>& own,
                               double width, double cutOff) {
    std::vector<bool> isOwn(own.size());
    for (std::size_t v = 0; v < own.size(); ++v) isOwn[v] = own[v] > 0.5;
    std::vector<double> field = own;
    smoother.smooth(field, std::vector<double>(own.size(), width), isOwn);
    for (double& a : field) a = std::max(0.0, (a - cutOff) / (1.0 - cutOff));
    return field;
}

/// The radius of the waist, the least of the spine's; `radius` where that is less.
double waistRadius(const std::vector<PlannedJoint>& joints, const std::vector<double>& radii,
                   double radius) {
    for (std::size_t j = 1; j < joints.size(); ++j)
        if (joints[j].isSpine() && radii[j] > 0.0) radius = std::min(radius, radii[j]);
    return radius;
}

/// Widths to start with, in rest units.
/// \param limb whether the joint is a limb's
/// \param onLimb whether the one above is
Widths firstWidths(const std::vector<PlannedJoint>& joints, std::size_t index, bool limb,
                   bool onLimb, const std::vector<double>& radii, double smoothing) {
    const PlannedJoint& joint = joints[index];
    const double radius = joint.isSpine() ? waistRadius(joints, radii, radii[index]) : radii[index];
    const auto times = [&](const Widths& widths) {
        return Widths{widths.above * smoothing * radius, widths.below * smoothing * radius};
    };
    if (joint.rigid >= 0) return times(kRigid);
    if (joint.trunk) return times(joint.collarBone ? kCollar : kSpine);
    if (joint.digit) {
        const Widths widths = times(kOther);
        return {std::min(widths.above, kDigit * joint.lengthAbove),
                std::min(widths.below, kDigit * joint.boneLength)};
    }
    Widths widths = times(limb && onLimb ? kBetweenLimbs : kOther);
    if (carries(joints, index, JointPart::Head))
        return widths; // necks bend over their whole length
    if (onLimb) widths.above = std::min(widths.above, kMaxShareOfBone * joint.lengthAbove);
    if (joint.boneLength > 0.0)
        widths.below = std::min(widths.below, kMaxShareOfBone * joint.boneLength);
    return widths;
}

/// The last joint of a finger or toe with several: all beyond it is its own.
bool isLastDigit(const std::vector<PlannedJoint>& joints, const PlannedJoint& joint) {
    return joint.digit && joint.child < 0 && joints[static_cast<std::size_t>(joint.parent)].digit;
}

/// The skin of a joint and all below it: an arm follows its collar bone wholly.
std::vector<bool> skinOf(const BinaryField& binary, int joint) {
    const std::vector<bool> isBelow = subtreeOf(binary.joints, static_cast<std::size_t>(joint));
    std::vector<bool> result(binary.regions.size());
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = isBelow[binary.regions[v]];
    return result;
}

/// Narrows a width, down to `least`, where `excess`, what the middle third has too much, is above
/// `most`. What a field has left a distance away goes about with the fifth power of its width.
bool narrow(double& width, double least, double excess, double most) {
    if (width <= least || excess <= kTolerance * most) return false;
    width = std::max(least, width * std::max(0.6, std::pow(most / excess, 0.2)));
    return true;
}

/// Where a field is neither 0 nor 1.
std::vector<bool> isPartial(const std::vector<double>& field) {
    std::vector<bool> result(field.size());
    for (std::size_t v = 0; v < field.size(); ++v) result[v] = field[v] > 0.0 && field[v] < 1.0;
    return result;
}

/// Evens out what an arm's swings do to the skin between it and the trunk. Its middle third stays
/// as it is.
/// \param isFree which vertices may change
void evenOut(const BinaryField& binary, const SkinSmoother& smoother, std::size_t joint,
             const MiddleThird& third, double width, std::vector<bool> isFree,
             std::vector<double>& field) {
    const std::vector<glm::dvec3> swings = armSwings(binary.joints, joint);
    if (swings.empty()) return;
    for (const std::uint32_t v : third.vertices()) isFree[v] = false;
    keepLooseSkin(smoother.skin(), field, isFree);
    const glm::dvec3& centre = binary.joints[joint].centre;
    smoother.change(field, isFree, width,
                    [&](const HeatGraph& skin, std::vector<double>& coarse,
                        const std::vector<bool>& coarseFree) {
                        evenStretch(skin, coarse, coarseFree, centre, swings);
                    });
}

} // namespace

void stretch(std::vector<double>& field, double cutOff) {
    for (double& a : field) a = std::clamp((a - cutOff) / (1.0 - 2.0 * cutOff), 0.0, 1.0);
}

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
    const MiddleThird own = limb ? MiddleThird(binary, joint) : MiddleThird();
    const MiddleThird previous = onLimb ? MiddleThird(binary, above) : MiddleThird();
    if (!planned.beyond.empty()) {
        double width = kAboveBorder * options.smoothing * radius;
        const double least = kNarrowest * width;
        std::vector<double> field = fromBorder(smoother, start, width, options.cutOff);
        for (int i = 0; i < kTries && !previous.empty() &&
                        narrow(width, least, previous.mean(field), kNextRigidity);
             ++i)
            field = fromBorder(smoother, start, width, options.cutOff);
        return field;
    }
    Widths widths = firstWidths(binary.joints, joint, limb, onLimb, radii, options.smoothing);
    const Widths least = {kNarrowest * widths.above, kNarrowest * widths.below};
    const std::vector<bool> isHeld =
        planned.collarBone ? skinOf(binary, planned.child) : std::vector<bool>();
    std::vector<double> share;
    if (limb && binary.joints[above].trunk)
        share =
            slopeShare(binary.mesh, spread(smoother, start, widths, {}, isHeld, options.cutOff));
    std::vector<double> field;
    for (int i = 0; i < kTries; ++i) {
        field = spread(smoother, start, widths, share, isHeld, options.cutOff);
        bool narrower = false;
        if (!own.empty())
            narrower = narrow(widths.below, least.below, 1.0 - own.mean(field), 1.0 - kOwnRigidity);
        if (!previous.empty())
            narrower =
                narrow(widths.above, least.above, previous.mean(field), kNextRigidity) || narrower;
        if (!narrower) break;
    }
    if (!share.empty()) {
        const Widths wider = {kRoom * widths.above, kRoom * widths.below};
        const std::vector<bool> isFree =
            isPartial(spread(smoother, start, wider, share, isHeld, options.cutOff));
        evenOut(binary, smoother, joint, own, options.smoothing * radius, isFree, field);
    }
    return field;
}

} // namespace osgSkin
