// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/RatioFields.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgSkin {
namespace {

/// A forearm's twist begins this far beyond the elbow, in lengths of the forearm: the more skin
/// takes part, the less it is strained. The upper arm's skin twists no more than it bends with the
/// elbow.
constexpr double kBeyondElbow = 0.2;

/// Fractions of the region over which the rate of the twist fades in below the elbow, where the
/// skin is thick and its rows of vertices are far apart, and out above the wrist.
constexpr double kFadeIn = 0.4;
constexpr double kFadeOut = 0.15;

/// The region is divided into sections, each with the mean radius of the skin within two sections.
constexpr std::size_t kStretches = 16;
using Radii = std::array<double, kStretches>;

Radii limbRadiiAlong(const WeldedMesh& mesh, const PlannedJoint& joint, const BoundarySpan& region,
                     const std::vector<double>& onBone, const std::vector<double>& beyond) {
    Radii sums{}, weights{};
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        if (onBone[v] < 0.5 || beyond[v] > 0.5) continue;
        const glm::dvec3 d = mesh.positions[v] - joint.centre;
        const double along = glm::dot(d, joint.twistAxis);
        const double t = (along / joint.poleLength - region.upper) / (region.lower - region.upper);
        if (t < 0.0 || t > 1.0) continue;
        const double radius = glm::length(d - along * joint.twistAxis);
        for (std::size_t i = 0; i < kStretches; ++i) {
            const double away = std::abs(t * kStretches - (static_cast<double>(i) + 0.5));
            const double weight = std::max(0.0, 1.0 - 0.5 * away);
            sums[i] += weight * radius;
            weights[i] += weight;
        }
    }
    // A section without skin takes the radius of the one before.
    double last = 1.0;
    for (std::size_t i = kStretches; i-- > 0;)
        if (weights[i] > 0.0 && sums[i] > 0.0) last = sums[i] / weights[i];
    for (std::size_t i = 0; i < kStretches; ++i)
        sums[i] = last = weights[i] > 0.0 && sums[i] > 0.0 ? sums[i] / weights[i] : last;
    return sums;
}

double radiusAt(const Radii& radii, double t) {
    const double position = std::clamp(t * kStretches - 0.5, 0.0, kStretches - 1.0);
    const auto i = std::min(static_cast<std::size_t>(position), kStretches - 2);
    return radii[i] + (radii[i + 1] - radii[i]) * (position - static_cast<double>(i));
}

/// A hand's twist along the forearm.
///
/// A twist shears the skin by its rate times the limb's radius. Eq. 5 is steepest in the middle,
/// where an edge of a coarse mesh would cut across the limb at large twists. Here the rate is
/// proportional to the inverse of the limb's radius, so that the shear is the same everywhere, and
/// fades in and out at the boundaries.
class TwistProfile {
public:
    /// \param mesh the skin
    /// \param joint the hand
    /// \param region along its pole bone
    /// \param onBone bend field of the joint that moves the pole bone
    /// \param beyond bend field of the joint at the bone's end: its skin is ignored for the radius
    TwistProfile(const WeldedMesh& mesh, const PlannedJoint& joint, const BoundarySpan& region,
                 const std::vector<double>& onBone, const std::vector<double>& beyond) {
        const Radii radii = limbRadiiAlong(mesh, joint, region, onBone, beyond);
        for (std::size_t i = 0; i < kSteps; ++i) {
            const double t = (static_cast<double>(i) + 0.5) / kSteps;
            const double fade = std::min({1.0, t / kFadeIn, (1.0 - t) / kFadeOut});
            _ratio[i + 1] = _ratio[i] + fade / radiusAt(radii, t);
        }
        const double whole = _ratio.back();
        for (double& ratio : _ratio) ratio /= whole;
    }

    /// Ratio, 0 to 1, at t: 0 at the upper boundary, 1 at the lower; constant beyond both.
    double operator()(double t) const {
        const double position = std::clamp(t, 0.0, 1.0) * kSteps;
        const auto i = std::min(static_cast<std::size_t>(position), kSteps - 1);
        return _ratio[i] + (_ratio[i + 1] - _ratio[i]) * (position - static_cast<double>(i));
    }

private:
    static constexpr std::size_t kSteps = 64;
    std::array<double, kSteps + 1> _ratio{};
};

/// The boundaries of a twist region, along the pole bone.
BoundarySpan twistBoundaries(const PlannedJoint& joint, double radius) {
    if (!joint.poleIsParent)
        return chosenSpan(joint.options.twistUpper, joint.options.twistLower, {0.0, 1.0});
    // A forearm's twist ends one radius beyond the wrist, where the hand's bend ends, too.
    return chosenSpan(joint.options.twistUpper, joint.options.twistLower,
                      {-1.0 - kBeyondElbow, std::min(radius / joint.poleLength, 0.5)});
}

/// True if the twist has a region of its own, along a limb to the next joint or the last bone's
/// tip. Other twists follow the bend.
bool buildsUp(const PlannedJoint& joint, double radius) {
    if (!(joint.poleLength > 0.0) || joint.topmost || joint.isDigit()) return false;
    if (joint.options.twistUpper || joint.options.twistLower || joint.poleIsParent) return true;
    return isLimb(joint, radius);
}

/// The field along the pole bone, the joint's own or the one above, over the skin that the bone's
/// joint bends. It follows eq. 5 (hermiteRatio()), or TwistProfile along a forearm, as hands twist
/// far.
std::vector<double> alongBone(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                              std::size_t j, double radius, const JointFields& bend) {
    const PlannedJoint& joint = joints[j];
    const BoundarySpan region = twistBoundaries(joint, radius);
    const std::vector<double> own = bend.values(j);
    const std::vector<double> onBone =
        joint.poleIsParent ? bend.values(regionAbove(joints, j)) : own;
    std::optional<TwistProfile> evenShear;
    if (joint.poleIsParent && !joint.options.twistUpper && !joint.options.twistLower)
        evenShear.emplace(mesh, joint, region, onBone, own);
    std::vector<double> field(mesh.vertexCount());
    for (std::size_t v = 0; v < field.size(); ++v) {
        const double along =
            glm::dot(mesh.positions[v] - joint.centre, joint.twistAxis) / joint.poleLength;
        const double t = (along - region.upper) / (region.lower - region.upper);
        field[v] = std::min(evenShear ? (*evenShear)(t) : hermiteRatio(t), onBone[v]);
        if (joint.poleIsParent) field[v] = std::max(field[v], own[v]);
    }
    return field;
}

} // namespace

std::optional<BoundarySpan> twistSpan(const PlannedJoint& joint, double radius) {
    if (!buildsUp(joint, radius)) return std::nullopt;
    return twistBoundaries(joint, radius);
}

JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend) {
    JointFields twist = bend;
    const std::vector<std::vector<std::uint32_t>> children = freeChildren(joints);
    for (std::size_t j = joints.size(); j-- > 1;) {
        if (joints[j].belowRigid(static_cast<int>(j))) continue;
        const bool isOwn = buildsUp(joints[j], radii[j]);
        if (!isOwn && children[j].empty()) continue;
        std::vector<double> values =
            isOwn ? alongBone(mesh, joints, j, radii[j], bend) : bend.values(j);
        // Where a child begins to rotate skin, this joint's twist must be at least as large.
        for (const std::uint32_t child : children[j]) {
            raise(values, bend.entries(child));
            raise(values, twist.entries(child));
        }
        twist.set(j, values);
    }
    return twist;
}

} // namespace osgSkin
