// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/MakeShapes.h"

#include "correctives/Anatomy.h"
#include "correctives/JointSections.h"
#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"
#include "correctives/SkinRelaxation.h"
#include "mesh/CoarseGraph.h"
#include "mesh/Parallel.h"
#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using Points = std::vector<glm::dvec3>;

/// A bent joint. Points are relative to its centre, in the space of the bone above at rest.
struct FoldShape {
    glm::dvec3 above;    ///< a: unit, direction of the bone above
    glm::dvec3 boneRest; ///< b0: unit, the bone at rest
    glm::dvec3 bone;     ///< b: unit, the bent bone
    double radius;       ///< of the limb
    double angle;        ///< between a and b, degrees: 0 is straight
    double angleAtRest;  ///< between a and b0
    /// Unit normal, towards the child's side, of the plane in which both sides meet: the bisecting
    /// plane, or one that leaves more room to the side with more flesh.
    glm::dvec3 normal;
};

/// A vertex at rest, as all bends need it.
struct RestPoint {
    glm::dvec3 at;
    double height;     ///< from the plane that bisects the joint, positive on the child's side
    double childShare; ///< how much it belongs to the child's side of the joint, 0 to 1
    double distance;   ///< from the bone, blended where both sides of the joint meet
};

/// The remaining bulge, in limb radii.
constexpr double kBulgeLeft = 0.005;

/// Distance along the bone, in radii, beyond which sections are restored wholly.
constexpr double kRestoreFull = 2.0;

/// Depths inside the fold between which widening sets in, in radii from the bone.
constexpr double kWidenFrom = -1.5;
constexpr double kWidenFull = -0.5;

/// Half the width of the transition from the parent's to the child's side, in radii.
constexpr double kSideWidth = 0.25;

/// Sine of the least angle between the bones at which a limb has an inner side.
constexpr double kMinFold = 0.1;

/// Gap between the skins on both sides of a fold, far from the joint, and how softly they meet, in
/// radii.
constexpr double kGap = 0.2;
constexpr double kSoftness = 0.2;

/// Angles between which the press sets in, in degrees.
constexpr double kPressFrom = 45.0;
constexpr double kPressFull = 75.0;

/// The same for the crease, and how far from the joint's plane it reaches, in radii.
constexpr double kCreaseFrom = 80.0;
constexpr double kCreaseFull = 120.0;
constexpr double kCreaseCore = 0.1;
constexpr double kCreaseEdge = 0.5;

/// A smooth maximum.
double softMax(double a, double b, double width) {
    return 0.5 * (a + b + std::sqrt((a - b) * (a - b) + width * width));
}

/// 0 up to the angle `from`, 1 beyond `full`, in degrees; later if the limb is bent at rest.
double since(const FoldShape& fold, double from, double full) {
    return hermiteRatio((fold.angle - std::max(from, fold.angleAtRest)) / (full - from));
}

/// Direction, away from the joint, of the bone beside a vertex; the bisecting plane separates both.
glm::dvec3 boneOf(const FoldShape& fold, const glm::dvec3& posed) {
    return glm::dot(fold.above + fold.bone, posed) < 0.0 ? -fold.above : fold.bone;
}

/// Signed distance from the bisecting plane that pressed skin keeps.
double limitOf(const FoldShape& fold, const RestPoint& rest) {
    return kGap * fold.radius * rest.height / (std::abs(rest.height) + fold.radius);
}

/// A smooth minimum of `wish` and `room`, never more than either; both at least 0.
double limitedTo(double wish, double room) {
    if (!(room > 0.0)) return 0.0;
    const double t = wish / room, square = t * t;
    return wish / std::sqrt(std::sqrt(1.0 + square * square));
}

std::vector<RestPoint> restPointsOf(const ShapedJoint& joint, const Points& skin) {
    const glm::dvec3 normal = glm::normalize(joint.above + joint.bone);
    std::vector<RestPoint> points;
    for (const glm::dvec3& at : skin) {
        const auto from = [&at](const glm::dvec3& bone) {
            const double z = std::max(glm::dot(bone, at), 0.0);
            return std::sqrt(std::max(glm::dot(at, at) - z * z, 0.0));
        };
        const double height = glm::dot(at, normal);
        const double childs = hermiteRatio(0.5 + 0.5 * height / (kSideWidth * joint.radius));
        points.push_back(
            {at, height, childs, glm::mix(from(-joint.above), from(joint.bone), childs)});
    }
    return points;
}

/// A bone that skin is restored to.
struct RestoringBone {
    glm::dvec3 atRest; ///< unit, away from the joint
    glm::dvec3 posed;
    glm::dquat turn; ///< takes `atRest` to `posed`
    double side;     ///< 1 on the child's side of the joint, -1 on the parent's
};

/// The displacement across the bone.
glm::dvec3 restoringMove(const FoldShape& fold, const RestoringBone& bone, const RestPoint& rest,
                         const glm::dvec3& clamped) {
    const glm::dvec3& m = bone.posed;
    const double z = glm::dot(m, clamped);
    const double share = hermiteRatio(z / (kRestoreFull * fold.radius));
    if (!(share > 0.0)) return glm::dvec3(0.0);
    const glm::dvec3 radial = bone.turn * (rest.at - glm::dot(bone.atRest, rest.at) * bone.atRest);
    glm::dvec3 move = share * (radial - (clamped - z * m));
    const glm::dvec3 inwards = fold.bone - fold.above;
    const glm::dvec3 across = inwards - glm::dot(m, inwards) * m;
    const double length = glm::length(across);
    if (length < kMinFold) return move;
    const glm::dvec3 inner = across / length;
    const double wish = glm::dot(inner, move);
    if (!(wish > 0.0)) return move;
    // If the plane's normal leans towards the bone, `inner` points to the plane.
    const glm::dvec3 normal = bone.side * fold.normal;
    const double room = (glm::dot(normal, clamped) - bone.side * limitOf(fold, rest)) /
                        std::max(-glm::dot(normal, inner), 1e-3);
    return move + (limitedTo(wish, room) - wish) * inner;
}

/// Against bulges: moves a vertex back to its distance from the bone at rest, unless it is nearer.
glm::dvec3 clampBulge(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed) {
    const bool onParent = glm::dot(fold.above + fold.bone, posed) < 0.0;
    const glm::dvec3 m = onParent ? -fold.above : fold.bone;
    const glm::dvec3 m0 = onParent ? -fold.above : fold.boneRest;
    const double z = std::max(glm::dot(m, posed), 0.0);
    const double z0 = std::max(glm::dot(m0, rest), 0.0);
    const double d = std::sqrt(std::max(glm::dot(posed, posed) - z * z, 0.0));
    const double d0 = std::sqrt(std::max(glm::dot(rest, rest) - z0 * z0, 0.0));
    const double t = std::max(d - d0, 0.0);
    if (!(t > 0.0)) return posed;
    const double k = t * t / ((t + kBulgeLeft * fold.radius) * d);
    return (1.0 - k) * posed + k * z * m;
}

/// Moves a vertex across its bone to where it would be if it followed the bone rigidly; its
/// position along the bone stays. Plain skin lags behind the bone, so it leaves the inner side and
/// bulges on the outer one; this restores the sections beside the joint. Skin of the inner side
/// stops before the plane in which both sides meet.
/// \param clamped of clampBulge()
/// \param turn the whole bend with the vertex's own share of the twist
glm::dvec3 restoreSection(const FoldShape& fold, const RestPoint& rest, const glm::dvec3& clamped,
                          const glm::dquat& turn) {
    const double childs = rest.childShare;
    const glm::dquat unit(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 moved(0.0);
    if (childs > 0.0)
        moved += childs * restoringMove(fold, {fold.boneRest, fold.bone, turn, 1.0}, rest, clamped);
    if (childs < 1.0)
        moved += (1.0 - childs) *
                 restoringMove(fold, {-fold.above, -fold.above, unit, -1.0}, rest, clamped);
    return clamped + moved;
}

/// How far a vertex lies on the inner side of its bone, in radii.
double depthIn(const FoldShape& fold, const glm::dvec3& posed) {
    const glm::dvec3 inwards = fold.bone - fold.above;
    const glm::dvec3 m = boneOf(fold, posed);
    // Measured across the bone; along it even the outer side lies inwards of the joint.
    const glm::dvec3 across = inwards - glm::dot(m, inwards) * m;
    const double length = glm::length(across);
    return length < 1e-6 ? 0.0 : glm::dot(across, posed) / (length * fold.radius);
}

/// Moves vertices sideways, parallel to the joint's bend axis, by a share of their distances from
/// the bone. The flanks and the inner side widen; the outer side keeps its shape.
class Widening {
public:
    /// \param points posed
    Widening(const FoldShape& fold, const std::vector<RestPoint>& rest,
             const std::vector<glm::dvec3>& points);

    /// The widened points.
    std::vector<glm::dvec3> by(const JointSections::Sides& shares) const;

private:
    struct Vertex {
        double onParent, onChild; ///< distance from the joint along each bone, radii
        double childShare;
        double move; ///< by a share of 1, signed
        double room; ///< for the move
    };

    const std::vector<glm::dvec3>& _points;
    glm::dvec3 _sideways{0.0};
    std::vector<Vertex> _vertices; ///< none if the limb is straight
};

/// Against self-intersection: keeps a vertex on its own side of the plane in which both sides meet,
/// and presses the skin flat against it.
glm::dvec3 pressFold(const FoldShape& fold, const RestPoint& rest, const glm::dvec3& posed) {
    const double onset = since(fold, kPressFrom, kPressFull);
    const glm::dvec3 sum = fold.above + fold.bone, inwards = fold.bone - fold.above;
    if (!(onset > 0.0) || glm::length(sum) < 1e-3 || glm::length(inwards) < 1e-3) return posed;
    const glm::dvec3& n = fold.normal;
    const double r = fold.radius;
    const double h = glm::dot(posed, n);
    const double limit = limitOf(fold, rest);
    const double childs = softMax(h, limit, kSoftness * r);
    const double parents = -softMax(-h, -limit, kSoftness * r);
    // The crease lies between both sides, else it would cut into the one pressed upon it.
    const double deep =
        since(fold, kCreaseFrom, kCreaseFull) *
        (1.0 - hermiteRatio((std::abs(rest.height) / r - kCreaseCore) / kCreaseEdge));
    const double pressed = glm::mix(glm::mix(parents, childs, rest.childShare), limit, deep);
    const double inside = hermiteRatio(0.2 + 2.0 * glm::dot(glm::normalize(inwards), posed) / r);
    return posed + onset * inside * (pressed - h) * n;
}

/// A joint's skin at one bend, and its targets by closed forms. Points are relative to the joint's
/// centre, one for each of its vertices.
class BentSkin {
public:
    /// \param relaxation of the joint
    /// \param rest restPointsOf() the joint
    /// \param childShare the share of the angle between both bones that the child's flesh fills
    BentSkin(const ShapedJoint& joint, const SkinRelaxation& relaxation,
             const std::vector<RestPoint>& rest, const BendTwist& bend, double childShare = 0.5);

    /// The rotation of each vertex.
    const std::vector<glm::dquat>& turns() const { return _turns; }

    /// Six times the volume between the skin and the joint's centre.
    static double volumeOf(const ShapedJoint& joint, const std::vector<glm::dvec3>& points);

    /// Where the vertices should be.
    /// \param sections null at the trunk
    std::vector<glm::dvec3> targets(double volumeAtRest, const JointSections* sections) const;

    /// Weights of the vertices' targets, see JointShapes.
    std::vector<double> weights() const;

private:
    std::vector<glm::dvec3> limbTargets(const JointSections& sections) const;
    JointSections::Sides sharesFor(const Widening& widening, const std::vector<glm::dvec3>& shaped,
                                   const JointSections& sections) const;
    std::vector<glm::dvec3> trunkTargets(double volumeAtRest) const;

    /// Adds ShapedJoint::slide, in full where the ratio is 1/2. Skin does not slide across the
    /// plane in which both sides of a fold meet: the displacement is along it.
    std::vector<glm::dvec3> slid(std::vector<glm::dvec3> points) const;

    const ShapedJoint& _joint;
    const SkinRelaxation& _relaxation;
    const std::vector<RestPoint>& _rest;
    BendTwist _bend;
    FoldShape _fold;
    std::vector<glm::dquat> _turns;
    std::vector<glm::dvec3> _posed;
};

/// Widths that are tried, as shares of the distance from the bone.
constexpr double kWidths[] = {0.1, 0.2, 0.4, 0.7, 1.0};

/// Distance along the bone, in radii, beyond which sections are widened wholly; the joint itself
/// keeps its shape.
constexpr double kWidensFully = 1.2;

/// Largest distance of widened skin from its bone, over that at rest: up to a bend, in degrees, and
/// from a deeper one on.
constexpr double kMaxOut = 1.0, kMaxOutAt = 120.0;
constexpr double kMaxOutDeep = 1.26, kMaxOutDeepAt = 142.0;

/// How deep inside a fold at the trunk bulges are still clamped, in radii of the limb.
constexpr double kTrunkDepth = 0.3;

/// The share that a limb at the trunk keeps of the volume that it gains by a bend: about as much is
/// lost in the folds of other joints.
constexpr double kGainKept = 0.5;

/// Weight of the skin inside a fold, relative to that outside. It is low between limbs, as
/// everybody sees the outside. It is high at the trunk, where nothing presses the inner skin flat:
/// errors from fitting the outside would make it intersect itself.
constexpr double kInsideLimbs = 0.1;
constexpr double kInsideTrunk = 20.0;

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Unit normal of a plane between the bones, at a share of the angle between them.
glm::dvec3 planeBetween(const glm::dvec3& above, const glm::dvec3& bone, double childShare) {
    const glm::dvec3 sum = above + bone, inwards = bone - above;
    if (glm::length(sum) < 1e-3) return bone;
    const glm::dvec3 normal = glm::normalize(sum);
    if (glm::length(inwards) < 1e-3) return normal;
    const double angle = glm::pi<double>() - glm::radians(degreesBetween(above, bone));
    const double lean = (childShare - 0.5) * angle;
    return std::cos(lean) * normal + std::sin(lean) * glm::normalize(inwards);
}

FoldShape foldAt(const ShapedJoint& joint, const glm::dquat& turn, double childShare) {
    const glm::dvec3 bone = turn * joint.bone;
    return {joint.above,
            joint.bone,
            bone,
            joint.radius,
            degreesBetween(joint.above, bone),
            degreesBetween(joint.above, joint.bone),
            planeBetween(joint.above, bone, childShare)};
}

Points between(Points from, const Points& to, double share) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] += share * (to[i] - from[i]);
    return from;
}

double maxOutAt(double angle) {
    return glm::mix(kMaxOut, kMaxOutDeep,
                    hermiteRatio((angle - kMaxOutAt) / (kMaxOutDeepAt - kMaxOutAt)));
}

/// \param radii along the bone
double widthAt(const JointSections::Values& shares, double radii) {
    return hermiteRatio(radii / kWidensFully) * JointSections::valueAt(shares, radii);
}

Widening::Widening(const FoldShape& fold, const std::vector<RestPoint>& rest, const Points& points)
    : _points(points) {
    const glm::dvec3 axis = glm::cross(fold.above, fold.bone);
    const double sine = glm::length(axis);
    if (sine < kMinFold) return;
    _sideways = axis / sine;
    const double most = maxOutAt(fold.angle);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3& x = points[i];
        const double at = glm::dot(_sideways, x);
        const double z = std::max(glm::dot(boneOf(fold, x), x), 0.0);
        const double across = glm::dot(x, x) - z * z - at * at; // squared
        const double mostAcross = most * rest[i].distance;
        const double room =
            std::sqrt(std::max(mostAcross * mostAcross - across, 0.0)) - std::abs(at);
        const double inside =
            hermiteRatio((depthIn(fold, x) - kWidenFrom) / (kWidenFull - kWidenFrom));
        _vertices.push_back({-glm::dot(fold.above, x) / fold.radius,
                             glm::dot(fold.bone, x) / fold.radius, rest[i].childShare, inside * at,
                             room});
    }
}

Points Widening::by(const JointSections::Sides& shares) const {
    Points result = _points;
    for (std::size_t i = 0; i < _vertices.size(); ++i) {
        const Vertex& vertex = _vertices[i];
        if (!(vertex.room > 0.0) || vertex.move == 0.0) continue;
        const double share = glm::mix(widthAt(shares.parent, vertex.onParent),
                                      widthAt(shares.child, vertex.onChild), vertex.childShare);
        const double move = limitedTo(share * std::abs(vertex.move), vertex.room);
        result[i] += std::copysign(move, vertex.move) * _sideways;
    }
    return result;
}

BentSkin::BentSkin(const ShapedJoint& joint, const SkinRelaxation& relaxation,
                   const std::vector<RestPoint>& rest, const BendTwist& bend, double childShare)
    : _joint(joint), _relaxation(relaxation), _rest(rest), _bend(bend),
      _fold(foldAt(joint, partialRotation(bend, joint.twistAxis, 1.0, 1.0), childShare)),
      _turns(joint.turnsOf(bend)) {
    for (std::size_t i = 0; i < _turns.size(); ++i) _posed.push_back(_turns[i] * rest[i].at);
}

double BentSkin::volumeOf(const ShapedJoint& joint, const Points& points) {
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : joint.triangles)
        volume += glm::dot(points[t[0]], glm::cross(points[t[1]], points[t[2]]));
    return volume;
}

Points BentSkin::targets(double volumeAtRest, const JointSections* sections) const {
    if (_joint.isSoft) return slid(_posed);
    return sections ? limbTargets(*sections) : trunkTargets(volumeAtRest);
}

/// Shares by which sections are widened to keep their areas.
JointSections::Sides BentSkin::sharesFor(const Widening& widening, const Points& shaped,
                                         const JointSections& sections) const {
    const JointSections::Sides areas = sections.areasOf(_fold.above, _fold.bone, shaped);
    WidthSearch parent(sections.atRest().parent, areas.parent),
        child(sections.atRest().child, areas.child);
    for (const double width : kWidths) {
        JointSections::Sides all;
        all.parent.fill(width);
        all.child.fill(width);
        const JointSections::Sides wide =
            sections.areasOf(_fold.above, _fold.bone, widening.by(all));
        parent.add(width, wide.parent);
        child.add(width, wide.child);
    }
    return {parent.shares, child.shares};
}

Points BentSkin::limbTargets(const JointSections& sections) const {
    Points clamps;
    for (std::size_t i = 0; i < _posed.size(); ++i)
        clamps.push_back(clampBulge(_fold, _rest[i].at, _posed[i]) - _posed[i]);
    // Beside a kneecap neighbours are clamped by different lengths, and would fold.
    clamps = _relaxation.smoothed(std::move(clamps));
    const bool twists = std::abs(_bend.twistAngle) > 1e-9;
    glm::dquat turn = partialRotation(_bend, _joint.twistAxis, 1.0, 1.0);
    Points shaped;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        if (twists) turn = partialRotation(_bend, _joint.twistAxis, 1.0, _joint.vertices[i].twist);
        const glm::dvec3 clamped = _posed[i] + clamps[i];
        shaped.push_back(
            pressFold(_fold, _rest[i], restoreSection(_fold, _rest[i], clamped, turn)));
    }
    // The fold takes area from the sections beside it, so flesh moves to their flanks.
    const Widening widening(_fold, _rest, shaped);
    Points targets = widening.by(sharesFor(widening, shaped, sections));
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        targets[i] = _posed[i] + vertex.limb * vertex.fade * (targets[i] - _posed[i]);
    }
    return slid(std::move(targets));
}

Points BentSkin::slid(Points points) const {
    const glm::dvec3 move = _joint.slide * _joint.radius * (_fold.bone - _fold.boneRest);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        points[i] += 4.0 * vertex.bend * (1.0 - vertex.bend) * vertex.fade * move;
    }
    return points;
}

/// Removes the bulge outside, but no more volume than the bend has added.
Points BentSkin::trunkTargets(double volumeAtRest) const {
    Points lean;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        const double outside =
            1.0 - hermiteRatio(0.5 + 0.5 * depthIn(_fold, _posed[i]) / kTrunkDepth);
        const glm::dvec3 target = clampBulge(_fold, _rest[i].at, _posed[i]);
        lean.push_back(_posed[i] + outside * vertex.limb * vertex.fade * (target - _posed[i]));
    }
    const double plain = volumeOf(_joint, _posed), now = volumeOf(_joint, lean);
    const double least = plain - (1.0 - kGainKept) * std::max(plain - volumeAtRest, 0.0);
    return slid(now < least ? between(lean, _posed, (least - now) / (plain - now)) : lean);
}

std::vector<double> BentSkin::weights() const {
    const double inside = _joint.isAtTrunk() ? kInsideTrunk : kInsideLimbs;
    std::vector<double> weights;
    for (const glm::dvec3& x : _posed)
        weights.push_back(glm::mix(1.0, inside, hermiteRatio(0.5 + depthIn(_fold, x))));
    return weights;
}

/// The number of modes of a joint. With two, knees at 120 degrees would still intersect themselves,
/// and raised arms fold. The small slides of necks, wrists and ankles need two. A joint between
/// limbs that bends in any direction has as many shapes as directions.
std::size_t modesOf(const ShapedJoint& joint, CorrectiveJoint::Basis basis) {
    switch (basis) {
    case CorrectiveJoint::Basis::TurnedHinge:
        return 3;
    case CorrectiveJoint::Basis::Ball:
        return !(joint.slide > 0.0) ? 1 : joint.isSoft ? 2 : 3;
    default:
        return CorrectiveJoint::kMaxModes;
    }
}

/// Negligible displacement, in radii of the limb: of all vertices by a mode, and of a vertex by its
/// last modes (not for joints that bend in any direction).
constexpr double kFitTolerance = 1e-2;
constexpr double kMinVertexOffset = 2e-2;

/// Vertices of hinges whose largest offset is less than the first value stay; their offsets grow to
/// the whole at the second one. In radii of the limb.
constexpr double kUntouched = 0.07;
constexpr double kTouched = 0.15;

std::vector<BendTwist> bendsOf(const ShapedJoint& joint) {
    if (joint.functions.basis == CorrectiveJoint::Basis::TurnedHinge) return turnedBends(joint);
    std::vector<BendTwist> bends;
    for (const glm::dvec2& sample : bendSamples(joint)) bends.push_back(joint.bendAt(sample));
    return bends;
}

JointShapes shapesOf(const ShapedJoint& joint) {
    JointShapes shapes;
    shapes.functions = joint.functions;
    std::vector<glm::dvec3> atRest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        shapes.vertices.push_back(vertex.index);
        atRest.push_back(vertex.from);
    }
    std::optional<JointSections> sections;
    if (!joint.isAtTrunk()) sections.emplace(joint);
    const SkinRelaxation relaxation(joint);
    for (const BendTwist& bend : bendsOf(joint)) {
        const Points displaced = displacedByTissues(joint, atRest, bend, relaxation);
        const std::vector<RestPoint> rest = restPointsOf(joint, displaced);
        shapes.samples.push_back(
            joint.functions.coordinates(bend.bendAxis, bend.bendAngle, joint.twistAxis));
        const BentSkin skin(joint, relaxation, rest, bend, sections ? sections->childDepth() : 0.5);
        // A hinge's splines can meet all of its shapes.
        if (joint.functions.basis != CorrectiveJoint::Basis::TurnedHinge && !joint.isSoft)
            shapes.weights.push_back(skin.weights());
        shapes.offsets.push_back(relaxation.relaxed(
            skin.targets(BentSkin::volumeOf(joint, displaced), sections ? &*sections : nullptr),
            skin.turns()));
        Points& offsets = shapes.offsets.back();
        for (std::size_t i = 0; i < rest.size(); ++i)
            offsets[i] = glm::conjugate(skin.turns()[i]) * offsets[i] - atRest[i];
    }
    return shapes;
}

/// Fades out small offsets: vertices that hardly move would cost as much time as others.
void fadeSmallOffsets(double radius, JointShapes& shapes) {
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        double largest = 0.0;
        for (const std::vector<glm::dvec3>& offsets : shapes.offsets)
            largest = std::max(largest, glm::length(offsets[v]));
        const double share =
            hermiteRatio((largest / radius - kUntouched) / (kTouched - kUntouched));
        for (std::vector<glm::dvec3>& offsets : shapes.offsets) offsets[v] *= share;
    }
}

FittedShapes fittedShapesOf(const ShapedJoint& joint) {
    JointShapes shapes = shapesOf(joint);
    const CorrectiveJoint::Basis basis = shapes.functions.basis;
    if (basis == CorrectiveJoint::Basis::TurnedHinge) fadeSmallOffsets(joint.radius, shapes);
    FittedShapes result = fitShapes(shapes, {modesOf(joint, basis), kFitTolerance * joint.radius});
    if (basis != CorrectiveJoint::Basis::Round) result.tolerance = kMinVertexOffset * joint.radius;
    return result;
}

/// Shapes are computed on coarser copies of skin whose edges are shorter, in radii: the copies' are
/// still shorter than any detail of a shape.
constexpr double kFinestEdge = 0.08;

FittedShapes shapesOfFine(const ShapedJoint& joint) {
    std::vector<glm::dvec3> positions;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) positions.push_back(vertex.from);
    const HeatGraph fine(std::move(positions), joint.triangles);
    if (!(fine.meanEdge > 0.0) || fine.meanEdge > kFinestEdge * joint.radius)
        return fittedShapesOf(joint);
    const CoarseGraph coarser(fine);
    return finerShapes(shapesOfFine(coarserJoint(joint, coarser)), coarser, joint);
}

} // namespace

Correctives makeFastShapes(const RestSkeleton& skeleton, const JointRoles& roles,
                           const std::vector<PlannedJoint>& joints, const WeldedMesh& mesh,
                           const SkinLayers* layers, const Binding& binding) {
    std::vector<ShapedJoint> shaped = findShapedJoints(skeleton, joints, mesh, binding);
    for (ShapedJoint& soft : findSoftJoints(joints, mesh, binding))
        shaped.push_back(std::move(soft));
    std::vector<FittedShapes> all(shaped.size());
    parallelFor(shaped.size(), [&](std::size_t i) {
        addTissues(roles, joints, mesh, layers, shaped[i]);
        if (shaped[i].functions.basis == CorrectiveJoint::Basis::Hinge) setTurnedHinge(shaped[i]);
        all[i] = shapesOfFine(shaped[i]);
    });
    return packShapes(all, mesh.weldedOf);
}

} // namespace osgSkin
