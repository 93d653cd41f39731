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
#include <cstdio>
#include <cstdlib>

namespace osgSkin {
namespace {

/// Widths beside that of a limb. The trunk's joints stand so close that their fields overlap. A
/// rigid part starts close behind its joint, and the skin above takes up more of the rotation.
static double knob(const char*n,double d){return getenv(n)?atof(getenv(n)):d;}
const double kTrunkWidth = knob("K_TW",0.6);
const double kBetween=knob("K_BA",1.5), kBetweenBelow=knob("K_BB",0.75), kCollarShift=knob("K_CS",0.0), kCollarW=knob("K_CW",1.2);
constexpr double kAboveRigidWidth = 1.5;
constexpr double kRigidWidth = 0.6;

/// The same of a head, hand or foot above its border.
constexpr double kBorderWidth = 1.1;

/// The same of a finger's or toe's joint, in lengths of its bone on that side, and above a last one.
constexpr double kDigitWidth = 0.5;
constexpr double kTipWidth = 0.3;

/// A spine runs behind the belly. A plane this much below the joint, in radii, loses less of the
/// belly's volume.
const double kTrunkLift = knob("K_TL",0.15);

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

/// Width of a field on the two sides of its joint's plane.
struct Widths {
    double above, below;
};

Widths firstWidths(const PlannedJoint& joint, double radius, double smoothing) {
    const double width = smoothing * radius;
    if (joint.rigid >= 0) return {kAboveRigidWidth * width, kRigidWidth * width};
    if (joint.trunk) return {kTrunkWidth * width, kTrunkWidth * width};
    if (joint.digit)
        return {std::min(width, kDigitWidth * joint.lengthAbove),
                std::min(width, kDigitWidth * joint.boneLength)};
    return {width, width};
}

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

/// The field of a head, hand or foot, or a finger's tip: 1 on all that is its own, and from there on
/// falling to 0 over the limb above.
std::vector<double> fromBorder(const SkinSmoother& smoother, const std::vector<double>& own,
                               double width, double cutOff) {
    std::vector<bool> isOwn(own.size());
    for (std::size_t v = 0; v < own.size(); ++v) isOwn[v] = own[v] > 0.5;
    std::vector<double> field = own;
    smoother.smooth(field, std::vector<double>(own.size(), width), isOwn);
    for (double& a : field) a = std::max(0.0, (a - cutOff) / (1.0 - cutOff));
    return field;
}

/// The skin of arms and legs that a joint does not move: nothing of its field gets there. Empty where
/// there is none.
std::vector<bool> otherLimbs(const BinaryField& binary, std::size_t joint) {
    const std::vector<PlannedJoint>& joints = binary.joints;
    const std::vector<bool> inside = subtreeOf(joints, joint);
    std::vector<bool> isOther(joints.size(), false);
    bool any = false;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        isOther[j] = !inside[j] && !joints[j].isSpine() &&
                     (isOther[static_cast<std::size_t>(joints[j].parent)] ||
                      carries(joints, j, JointPart::Hand) || carries(joints, j, JointPart::Foot)) &&
                     !subtreeOf(joints, j)[joint];
        any = any || isOther[j];
    }
    if (!any) return {};
    std::vector<bool> isHeld(binary.regions.size());
    for (std::size_t v = 0; v < isHeld.size(); ++v) isHeld[v] = isOther[binary.regions[v]];
    return isHeld;
}

/// Narrows a width, down to `least`, where `excess`, what the middle third has too much, is above
/// `most`. What a field has left a distance away goes about with the fifth power of its width.
bool narrow(double& width, double least, double excess, double most) {
    if (width <= least || excess <= kTolerance * most) return false;
    width = std::max(least, width * std::max(0.6, std::pow(most / excess, 0.2)));
    return true;
}

/// Evens out what an arm's swings do to the skin between it and the trunk. Its middle third stays
/// as it is.
void evenOut(const BinaryField& binary, const SkinSmoother& smoother, std::size_t joint,
             const MiddleThird& third, double width, std::vector<double>& field) {
    const std::vector<glm::dvec3> swings = armSwings(binary.joints, joint);
    if (swings.empty()) return;
    std::vector<bool> isFree(field.size());
    for (std::size_t v = 0; v < field.size(); ++v) isFree[v] = field[v] > 0.0 && field[v] < 1.0;
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
    if(getenv("K_DBG")) fprintf(stderr,"joint %zu trunk %d collar %d topmost %d radius %.2f normal %.2f %.2f %.2f above %zu La %.2f Lb %.2f part %d ext %d hold %d\n",joint,planned.trunk,planned.collarBone,planned.topmost,radius,planeNormal(planned).x,planeNormal(planned).y,planeNormal(planned).z,regionAbove(binary.joints,joint),planned.lengthAbove,planned.boneLength,int(planned.part),planned.extremity,planned.holdsRegion);
    double shift = planned.trunk ? -kTrunkLift * radius : 0.0;
    if (planned.collarBone) shift = kCollarShift * planned.armDistance;
    std::vector<double> start = binary.divided(joint, shift);
    if (!(radius > 0.0)) return start;
    if (!planned.beyond.empty())
        return fromBorder(smoother, start, kBorderWidth * options.smoothing * radius,
                          options.cutOff);
    if (planned.digit && planned.child < 0 &&
        binary.joints[static_cast<std::size_t>(planned.parent)].digit)
        return fromBorder(smoother, start, std::min(options.smoothing * radius, kTipWidth * planned.lengthAbove),
                          options.cutOff);

    const std::size_t above = regionAbove(binary.joints, joint);
    const bool limb = isLimb(planned, radius);
    const bool onLimb = above > 0 && isLimb(binary.joints[above], radii[above]);
    const MiddleThird own = limb ? MiddleThird(binary, joint) : MiddleThird();
    const MiddleThird previous = onLimb ? MiddleThird(binary, above) : MiddleThird();
    double wr = radius;
    if (planned.isSpine())
        for (std::size_t j = 1; j < radii.size(); ++j)
            if (binary.joints[j].isSpine() && radii[j] > 0.0) wr = std::min(wr, radii[j]);
    Widths widths = firstWidths(planned, wr, options.smoothing);
    if (onLimb && limb) { widths.above *= kBetween; widths.below *= kBetweenBelow; }
    if (limb && !onLimb) { widths.above *= knob("K_HA",1); widths.below *= knob("K_HB",1); }
    if (!planned.trunk && !carries(binary.joints, joint, JointPart::Head)) { const double cap=knob("K_CAP",.6); if (onLimb) widths.above=std::min(widths.above,cap*planned.lengthAbove); if (planned.boneLength>0) widths.below=std::min(widths.below,cap*planned.boneLength); }
    if (planned.collarBone) { widths.above *= kCollarW; widths.below *= kCollarW; }
    const Widths least = {kNarrowest * widths.above, kNarrowest * widths.below};
    std::vector<bool> isHeld;
    if (getenv("K_HOLD")) isHeld = otherLimbs(binary, joint);
    if (planned.collarBone) {
        const auto in = subtreeOf(binary.joints, planned.child);
        isHeld.assign(start.size(), false);
        const auto arm = false ? binary.divided(planned.child) : std::vector<double>();
        for (std::size_t v = 0; v < start.size(); ++v) isHeld[v] = arm.empty() ? in[binary.regions[v]] : arm[v] > .5;
    }
    std::vector<double> share;
    if (limb && binary.joints[above].trunk)
        share = slopeShare(binary.mesh, spread(smoother, start, widths, {}, isHeld, options.cutOff));
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
    if (!share.empty()) evenOut(binary, smoother, joint, own, options.smoothing * radius, field);
    return field;
}

} // namespace osgSkin
