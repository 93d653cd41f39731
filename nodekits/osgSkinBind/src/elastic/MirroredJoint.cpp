// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/MirroredJoint.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin::elastic {
namespace {

/// What counts as alike: lengths in radii of the limb, and the radii themselves as shares.
constexpr double kSameRadius = 0.05;
constexpr double kSameBone = 0.05;
constexpr double kSameSkin = 0.05;
constexpr double kSameRotation = 1e-2; ///< length of the difference of unit quaternions

/// Of a joint's reach: cells at the rim carry skin beyond it.
constexpr double kBeyondReach = 1.1;

/// Of bend ratios: mean over the vertices, and of each.
constexpr double kSameRatio = 0.01, kMaxRatioError = 0.2;

/// A corner with less of a point need not be known.
constexpr double kNoShare = 1e-6;

double reachOf(const ElasticJoint& joint) {
    return joint.radius * (joint.hinge ? ElasticJoint::kHingeReach : ElasticJoint::kBallReach);
}

Point toEigen(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

glm::dvec3 toGlm(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

bool isWithin(const ElasticBone& bone, const ElasticJoint& joint) {
    const glm::dvec3 along = bone.to - bone.from;
    const double square = glm::dot(along, along);
    const double t = square > 0.0
                         ? std::clamp(glm::dot(joint.centre - bone.from, along) / square, 0.0, 1.0)
                         : 0.0;
    return glm::distance(bone.from + t * along, joint.centre) < reachOf(joint);
}

/// True where each bone near `joint` has a mirror image among those of `other`.
bool bonesMatch(const MirrorPlane& plane, const ElasticJoint& joint, const ElasticJoint& other) {
    const double near = kSameBone * joint.radius;
    return std::all_of(joint.bones.begin(), joint.bones.end(), [&](const ElasticBone& bone) {
        if (!isWithin(bone, joint)) return true;
        const glm::dvec3 from = plane.mirrored(bone.from), to = plane.mirrored(bone.to);
        return std::any_of(other.bones.begin(), other.bones.end(), [&](const ElasticBone& each) {
            return each.moves == bone.moves && glm::distance(each.from, from) < near &&
                   glm::distance(each.to, to) < near;
        });
    });
}

/// For each of `wanted` the one of `given` whose mirror image it is; empty where one has none.
std::vector<std::size_t> samplesFor(const MirrorPlane& plane, const std::vector<glm::dquat>& wanted,
                                    const std::vector<glm::dquat>& given) {
    std::vector<std::size_t> result;
    for (const glm::dquat& sample : wanted) {
        const auto found = std::find_if(given.begin(), given.end(), [&](const glm::dquat& each) {
            const glm::dquat mirrored = plane.mirrored(each);
            return 2.0 - 2.0 * std::abs(glm::dot(mirrored, sample)) < kSameRotation * kSameRotation;
        });
        if (found == given.end()) return {};
        result.push_back(static_cast<std::size_t>(found - given.begin()));
    }
    return result;
}

} // namespace

glm::dvec3 MirrorPlane::mirrored(const glm::dvec3& point) const {
    return point - 2.0 * glm::dot(normal, point - through) * normal;
}

glm::dquat MirrorPlane::mirrored(const glm::dquat& rotation) const {
    const glm::dvec3 axis(rotation.x, rotation.y, rotation.z);
    const glm::dvec3 other = 2.0 * glm::dot(normal, axis) * normal - axis; // turns the other way
    return {rotation.w, other.x, other.y, other.z};
}

std::optional<MirroredJoint> MirroredJoint::find(const RestSkin& skin, const ElasticJoint& solved,
                                                 const ElasticJoint& joint) {
    const auto vertices = static_cast<std::size_t>(skin.positions().cols());
    const glm::dvec3 between = joint.centre - solved.centre;
    if (solved.hinge != joint.hinge || solved.samples.size() != joint.samples.size() ||
        std::abs(solved.radius - joint.radius) > kSameRadius * joint.radius ||
        !(glm::length(between) > joint.radius) || solved.ratios.size() != vertices ||
        joint.ratios.size() != vertices)
        return std::nullopt;
    MirroredJoint result(joint);
    const MirrorPlane plane =
        result._plane = {0.5 * (joint.centre + solved.centre), glm::normalize(between)};
    result._samples = samplesFor(plane, joint.samples, solved.samples);
    if (result._samples.empty() || !bonesMatch(plane, joint, solved) ||
        !bonesMatch(plane, solved, joint))
        return std::nullopt;

    double error = 0.0;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const glm::dvec3 rest = toGlm(skin.positions().col(v));
        const double away = glm::distance(rest, joint.centre) / reachOf(joint);
        const bool within = away < 1.0 || glm::distance(rest, solved.centre) < reachOf(solved);
        if (!within && away > kBeyondReach) continue;
        const RestSkin::Nearest nearest = skin.nearest(toEigen(plane.mirrored(rest)));
        if (nearest.distance > kSameSkin * joint.radius) {
            if (within) return std::nullopt;
            continue;
        }
        if (away > kBeyondReach) continue;
        Place& place = result._places.emplace_back();
        place.vertex = v;
        place.rest = rest;
        double ratio = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            place.corners[k] = skin.triangles()[nearest.triangle][k];
            place.shares[k] = nearest.shares[static_cast<Eigen::Index>(k)];
            ratio += place.shares[k] * solved.ratios[place.corners[k]];
        }
        const double off = std::abs(ratio - joint.ratios[v]);
        if (off > kMaxRatioError) return std::nullopt;
        error += off;
    }
    if (error > kSameRatio * static_cast<double>(result._places.size())) return std::nullopt;
    return result;
}

ElasticShapes MirroredJoint::shapes(const ElasticShapes& solved) const {
    ElasticShapes result;
    result.joint = _joint->name;
    result.reason = solved.reason;
    result.reach = reachOf(*_joint);
    result.cells = solved.cells;
    result.nodes = solved.nodes;
    std::vector<Place> places; // their corners as indices of the solved vertices
    for (Place place : _places) {
        bool known = true;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& corner = place.corners[k];
            if (place.shares[k] < kNoShare) {
                corner = 0;
                place.shares[k] = 0.0;
                continue;
            }
            const auto found =
                std::lower_bound(solved.vertices.begin(), solved.vertices.end(), corner);
            known = known && found != solved.vertices.end() && *found == corner;
            corner = static_cast<std::uint32_t>(found - solved.vertices.begin());
        }
        if (!known) continue;
        result.vertices.push_back(place.vertex);
        result.rest.push_back(place.rest);
        places.push_back(place);
    }
    const auto mirrored = [&](const Place& place, const std::vector<glm::dvec3>& positions) {
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < 3; ++k) sum += place.shares[k] * positions[place.corners[k]];
        return _plane.mirrored(sum);
    };
    for (std::size_t i = 0; i < solved.samples.size(); ++i) {
        const bool asked = i < _samples.size();
        ElasticSample sample = solved.samples[asked ? _samples[i] : i];
        sample.rotation = asked ? _joint->samples[i] : _plane.mirrored(sample.rotation);
        sample.seconds = 0.0;
        const std::vector<glm::dvec3> positions = std::move(sample.positions);
        sample.positions.clear();
        if (!positions.empty())
            for (const Place& place : places)
                sample.positions.push_back(mirrored(place, positions) + place.rest -
                                           mirrored(place, solved.rest));
        result.samples.push_back(std::move(sample));
    }
    return result;
}

} // namespace osgSkin::elastic
