// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/BentSkin.h"

#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Points = std::vector<glm::dvec3>;

/// Sections are widened until they have this share of their area at rest.
constexpr double kAreaKept = 0.97;

/// Shares of the distance from the bone that sections are tried to be widened by.
constexpr double kWidths[] = {0.1, 0.2, 0.4, 0.7, 1.0};

/// Distance along the bone, in radii, from which on sections are widened wholly: the joint itself
/// keeps its shape.
constexpr double kWidensFully = 1.2;

/// How far widened skin may get from its bone, over its distance at rest: at a bend, in degrees,
/// and at a deeper one.
constexpr double kMaxOut = 1.0, kMaxOutAt = 120.0;
constexpr double kMaxOutDeep = 1.26, kMaxOutDeepAt = 142.0;

/// How deep inside a fold at the trunk bulges are still clamped, in radii of the limb.
constexpr double kTrunkDepth = 0.3;

/// What a limb at the trunk keeps of the volume that a bend gives it: about as much is lost in
/// other joints' folds.
constexpr double kGainKept = 0.5;

/// What the skin inside a fold counts against the outer one. Where a limb folds on a limb less:
/// the outer one is what everybody sees. Where it folds on the trunk more: nothing presses that
/// skin flat, and what leaks there from the shape outside would make it go through itself.
constexpr double kInsideLimbs = 0.1;
constexpr double kInsideTrunk = 20.0;

/// Distances along a bone, in radii, between which the depth of flesh is measured.
constexpr double kDepthFrom = 1.0, kDepthTo = 2.5;

/// How far the child's share of the depth is followed, from one half.
constexpr double kMaxUneven = 0.08;

/// One bone with the skin of its side of the joint.
struct Bone {
    glm::dvec3 along;    ///< unit, away from the joint
    glm::dvec3 boundary; ///< direction, across `along`, towards the plane in which both sides meet
    double slope;        ///< distance of that plane from the bone, for each unit along the bone
};

/// \param share of the angle between both bones that this one's side takes
Bone boneAt(const glm::dvec3& along, const glm::dvec3& other, double share) {
    const glm::dvec3 across = other - glm::dot(along, other) * along;
    const double sine = glm::length(across);
    // A straight limb has no fold: any origin serves its sections, which are closed curves.
    if (sine < 0.1) return {along, glm::dvec3(0.0), 0.0};
    const double angle = std::atan2(sine, glm::dot(along, other));
    return {along, across / sine, std::tan(share * angle)};
}

/// Adds the triangle's part of each section's area: half the cross product of the edge in which it
/// meets the section. The origin lies in the plane in which both sides meet, where sections near
/// the joint are open: the missing edge adds nothing.
void addTriangle(const std::array<glm::dvec3, 3>& corners, const Bone& bone, double step,
                 JointSections::Values& areas) {
    std::array<double, 3> z{};
    for (std::size_t i = 0; i < 3; ++i) z[i] = glm::dot(corners[i], bone.along);
    const auto [least, most] = std::minmax_element(z.begin(), z.end());
    const double from = std::ceil(std::max(*least, 0.0) / step);
    if (!(from < JointSections::kCount + 1)) return;
    for (auto k = std::max<std::size_t>(1, static_cast<std::size_t>(from));
         k <= JointSections::kCount && double(k) * step < *most; ++k) {
        const double at = double(k) * step;
        const glm::dvec3 origin = at * (bone.along + bone.slope * bone.boundary);
        glm::dvec3 enter(0.0), leave(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if ((z[i] < at) == (z[j] < at)) continue;
            const glm::dvec3 x =
                corners[i] + (at - z[i]) / (z[j] - z[i]) * (corners[j] - corners[i]) - origin;
            (z[i] < at ? enter : leave) = x;
        }
        areas[k - 1] += 0.5 * glm::dot(bone.along, glm::cross(leave, enter));
    }
}

JointSections::Sides areasAcross(const ShapedJoint& joint, const std::vector<bool>& isChilds,
                                 const Bone& parent, const Bone& child, const Points& points) {
    JointSections::Sides areas;
    for (std::size_t t = 0; t < joint.triangles.size(); ++t) {
        const auto& triangle = joint.triangles[t];
        addTriangle({points[triangle[0]], points[triangle[1]], points[triangle[2]]},
                    isChilds[t] ? child : parent, JointSections::kStep * joint.radius,
                    isChilds[t] ? areas.child : areas.parent);
    }
    return areas;
}

/// 90 % of the flesh beside the joint reach no farther from the bone inwards; 0 where it is not
/// known.
double depthOf(const ShapedJoint& joint, const glm::dvec3& along) {
    if (!(glm::length(joint.hinge) > 0.0)) return 0.0;
    const glm::dvec3 inwards =
        glm::normalize(glm::cross(joint.hinge, glm::dot(along, joint.bone) > 0.0 ? along : -along));
    std::vector<double> depths;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        const double z = glm::dot(along, vertex.from) / joint.radius;
        if (z > kDepthFrom && z < kDepthTo && vertex.limb > 0.5)
            depths.push_back(glm::dot(inwards, vertex.from));
    }
    if (depths.size() < 8) return 0.0;
    const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 9 / 10);
    std::nth_element(depths.begin(), at, depths.end());
    return std::max(*at, 0.0);
}

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Unit normal of a plane between the bones, at a share of the angle between them from the child's.
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

/// Shares by which sections of one bone are widened, searched among growing ones.
class WidthSearch {
public:
    WidthSearch(const JointSections::Values& atRest, const JointSections::Values& areas)
        : _areas(areas) {
        for (std::size_t k = 0; k < atRest.size(); ++k) {
            _missing[k] = kAreaKept * atRest[k] - areas[k];
            _found[k] = !(_missing[k] > 0.0);
        }
    }

    /// \param areas of all sections widened by `share`
    void add(double share, const JointSections::Values& areas) {
        for (std::size_t k = 0; k < areas.size(); ++k) {
            if (_found[k]) continue;
            const double gained = areas[k] - _areas[k];
            const double part = gained > 0.0 ? std::min(1.0, _missing[k] / gained) : 1.0;
            shares[k] = glm::mix(_last, share, part);
            _found[k] = part < 1.0;
            _missing[k] -= gained;
            _areas[k] = areas[k];
        }
        _last = share;
    }

    JointSections::Values shares{};

private:
    JointSections::Values _areas, _missing{};
    std::array<bool, JointSections::kCount> _found{};
    double _last = 0.0;
};

} // namespace

JointSections::JointSections(const ShapedJoint& joint) : _joint(joint) {
    const double child = depthOf(joint, joint.bone), parent = depthOf(joint, -joint.above);
    if (child > 0.0 && parent > 0.0)
        _childDepth = std::clamp(child / (child + parent), 0.5, 0.5 + kMaxUneven);
    Points points;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) points.push_back(vertex.from);
    const glm::dvec3 normal = joint.above + joint.bone;
    for (const auto& t : joint.triangles)
        _isChilds.push_back(glm::dot(points[t[0]] + points[t[1]] + points[t[2]], normal) > 0.0);
    _atRest = areasAcross(joint, _isChilds, boneAt(-joint.above, joint.bone, 1.0 - _childDepth),
                          boneAt(joint.bone, -joint.above, _childDepth), points);
}

JointSections::Sides JointSections::areasOf(const FoldShape& fold, const Points& posed) const {
    return areasAcross(_joint, _isChilds, boneAt(-fold.above, fold.bone, 1.0 - _childDepth),
                       boneAt(fold.bone, -fold.above, _childDepth), posed);
}

double JointSections::valueAt(const Values& values, double radii) {
    // Quadratic B-splines: continuous slopes.
    const double t = radii / kStep - 1.0;
    const auto middle = static_cast<std::ptrdiff_t>(std::floor(std::clamp(t, -2.0, 100.0) + 0.5));
    const double f = std::clamp(t, -2.0, 100.0) - double(middle);
    const auto at = [&](std::ptrdiff_t i) {
        if (i >= static_cast<std::ptrdiff_t>(kCount)) return 0.0;
        return values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(i, 0))];
    };
    return 0.5 * (0.5 - f) * (0.5 - f) * at(middle - 1) + (0.75 - f * f) * at(middle) +
           0.5 * (0.5 + f) * (0.5 + f) * at(middle + 1);
}

BentSkin::BentSkin(const ShapedJoint& joint, const BendTwist& bend, double childShare)
    : _joint(joint), _bend(bend),
      _fold(foldAt(joint, partialRotation(bend, joint.twistAxis, 1.0, 1.0), childShare)) {
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        _posed.push_back(joint.turnOf(vertex, bend) * vertex.from);
}

double BentSkin::volumeOf(const ShapedJoint& joint, const Points& points) {
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : joint.triangles)
        volume += glm::dot(points[t[0]], glm::cross(points[t[1]], points[t[2]]));
    return volume;
}

Points BentSkin::targets(double volumeAtRest, const JointSections* sections) const {
    return sections ? limbTargets(*sections) : trunkTargets(volumeAtRest);
}

/// Moves the points sideways by shares of their distance from the bone.
Points BentSkin::widened(const Points& points, const JointSections::Sides& shares) const {
    Points result;
    const double r = _joint.radius, most = maxOutAt(_fold.angle);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 &x = points[i], &rest = _joint.vertices[i].from;
        const double parents = widthAt(shares.parent, -glm::dot(_fold.above, x) / r);
        const double childs = widthAt(shares.child, glm::dot(_fold.bone, x) / r);
        const double side = childShare(_fold, rest);
        result.push_back(widen(_fold, rest, x, glm::mix(parents, childs, side), most));
    }
    return result;
}

/// Shares by which sections are to be widened to keep their areas.
JointSections::Sides BentSkin::sharesFor(const Points& shaped,
                                         const JointSections& sections) const {
    const JointSections::Sides areas = sections.areasOf(_fold, shaped);
    WidthSearch parent(sections.atRest().parent, areas.parent),
        child(sections.atRest().child, areas.child);
    for (const double width : kWidths) {
        JointSections::Sides all;
        all.parent.fill(width);
        all.child.fill(width);
        const JointSections::Sides wide = sections.areasOf(_fold, widened(shaped, all));
        parent.add(width, wide.parent);
        child.add(width, wide.child);
    }
    return {parent.shares, child.shares};
}

Points BentSkin::limbTargets(const JointSections& sections) const {
    Points shaped;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        const glm::dquat turn = partialRotation(_bend, _joint.twistAxis, 1.0, vertex.twist);
        const glm::dvec3 clamped = clampBulge(_fold, vertex.from, _posed[i]);
        shaped.push_back(
            pressFold(_fold, vertex.from, restoreSection(_fold, vertex.from, clamped, turn)));
    }
    // The fold takes area from the sections beside it: flesh moves to their flanks.
    Points targets = widened(shaped, sharesFor(shaped, sections));
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        targets[i] = _posed[i] + vertex.limb * vertex.fade * (targets[i] - _posed[i]);
    }
    return targets;
}

/// No bulge outside; where that would cost volume that the bend has not given, less of it.
Points BentSkin::trunkTargets(double volumeAtRest) const {
    Points lean;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        const double outside =
            1.0 - hermiteRatio(0.5 + 0.5 * depthIn(_fold, _posed[i]) / kTrunkDepth);
        const glm::dvec3 target = clampBulge(_fold, vertex.from, _posed[i]);
        lean.push_back(_posed[i] + outside * vertex.limb * vertex.fade * (target - _posed[i]));
    }
    const double plain = volumeOf(_joint, _posed), now = volumeOf(_joint, lean);
    const double least = plain - (1.0 - kGainKept) * std::max(plain - volumeAtRest, 0.0);
    return now < least ? between(std::move(lean), _posed, (least - now) / (plain - now)) : lean;
}

std::vector<double> BentSkin::weights() const {
    const double inside = _joint.isAtTrunk() ? kInsideTrunk : kInsideLimbs;
    std::vector<double> weights;
    for (const glm::dvec3& x : _posed)
        weights.push_back(glm::mix(1.0, inside, hermiteRatio(0.5 + depthIn(_fold, x))));
    return weights;
}

} // namespace osgSkin
