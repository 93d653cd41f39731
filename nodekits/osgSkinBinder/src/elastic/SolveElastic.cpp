// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/SolveElastic.h"

#include "elastic/JointSolid.h"
#include "elastic/solid/RestSkin.h"
#include "mesh/Parallel.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace osgSkin::elastic {
namespace {

/// The plane midway between two joints.
struct MirrorPlane {
    glm::dvec3 through{0.0}, normal{0.0}; ///< normal: unit

    glm::dvec3 mirrored(const glm::dvec3& point) const;
    glm::dquat mirrored(const glm::dquat& rotation) const;
};

/// A joint that mirrors another one, such as the left knee and the right one, and takes its shapes.
/// The skins need not have mirrored vertices.
class MirroredJoint {
public:
    /// \param skin in rest space
    /// \param solved the joint that will be solved
    /// \param joint the other one; outlives this object
    /// \return not set if skin, ratios, bones or samples within reach are not mirror images
    static std::optional<MirroredJoint> find(const RestSkin& skin, const ElasticJoint& solved,
                                             const ElasticJoint& joint);

    /// The other joint's shapes.
    ElasticShapes shapes(const ElasticShapes& solved) const;

private:
    explicit MirroredJoint(const ElasticJoint& joint) : _joint(&joint) {}

    /// The mirrored position of a vertex of the other joint on the skin of the solved one.
    struct Place {
        std::uint32_t vertex = 0;
        glm::dvec3 rest{0.0};
        std::uint32_t corners[3] = {};
        double shares[3] = {};
    };

    const ElasticJoint* _joint;
    MirrorPlane _plane;
    std::vector<std::size_t> _samples; ///< for each sample of the other joint the solved one
    std::vector<Place> _places;
};

/// Tolerances: lengths in radii of the limb, radii relative to each other.
constexpr double kSameRadius = 0.05;
constexpr double kSameBone = 0.05;
constexpr double kSameSkin = 0.05;
constexpr double kSameRotation = 1e-2; ///< length of the difference of unit quaternions

/// Relative to a joint's reach: cells at the rim have skin beyond it.
constexpr double kBeyondReach = 1.1;

/// Tolerances of bend ratios: the mean over the vertices, and of each.
constexpr double kSameRatio = 0.01, kMaxRatioError = 0.2;

/// A corner with a smaller share may be unknown.
constexpr double kNoShare = 1e-6;

double reachOf(const ElasticJoint& joint) {
    return joint.radius * (joint.hinge ? ElasticJoint::kHingeReach : ElasticJoint::kBallReach);
}

bool isWithin(const ElasticBone& bone, const ElasticJoint& joint) {
    const glm::dvec3 along = bone.to - bone.from;
    const double square = glm::dot(along, along);
    const double t = square > 0.0
                         ? std::clamp(glm::dot(joint.centre - bone.from, along) / square, 0.0, 1.0)
                         : 0.0;
    return glm::distance(bone.from + t * along, joint.centre) < reachOf(joint);
}

/// True if each bone near `joint` has a mirror image among those of `other`.
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

/// For each of `wanted` the one of `given` that it mirrors; empty if one mirrors none.
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

glm::dvec3 MirrorPlane::mirrored(const glm::dvec3& point) const {
    return point - 2.0 * glm::dot(normal, point - through) * normal;
}

glm::dquat MirrorPlane::mirrored(const glm::dquat& rotation) const {
    const glm::dvec3 axis(rotation.x, rotation.y, rotation.z);
    const glm::dvec3 other =
        2.0 * glm::dot(normal, axis) * normal - axis; // the rotation is reversed
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

} // namespace
} // namespace osgSkin::elastic

namespace osgSkin {
namespace {

const double kLargestStep = glm::radians(15.0);
const double kSideways = glm::radians(20.0);

/// At these shares of the flexion from the rest pose a hinge is also bent sideways.
constexpr double kSidewaysAt[] = {0.4, 0.75, 1.0};

constexpr int kDirections = 8;
const double kBallStep = glm::radians(30.0);

/// Angles from 0 (excluded) to `end` in equal steps.
void addSteps(double end, const glm::dvec3& axis, std::vector<glm::dquat>& samples) {
    const int steps = static_cast<int>(std::ceil(std::abs(end) / kLargestStep - 1e-9));
    for (int i = 1; i <= steps; ++i) samples.push_back(glm::angleAxis(end * i / steps, axis));
}

/// An earlier joint that a joint mirrors, if there is one.
struct Mirror {
    std::size_t of = 0;
    std::optional<elastic::MirroredJoint> how;
};

std::vector<Mirror> mirrorsOf(const ElasticSkin& skin, const std::vector<ElasticJoint>& joints) {
    std::vector<Mirror> mirrors(joints.size());
    if (joints.size() < 2 || skin.triangles.empty()) return mirrors;
    elastic::Points positions(3, static_cast<Eigen::Index>(skin.positions.size()));
    for (std::size_t v = 0; v < skin.positions.size(); ++v)
        positions.col(static_cast<Eigen::Index>(v)) = elastic::toEigen(skin.positions[v]);
    const elastic::RestSkin rest(std::move(positions), skin.triangles);
    std::vector<bool> taken(joints.size(), false);
    for (std::size_t i = 1; i < joints.size(); ++i)
        for (std::size_t k = 0; k < i && !mirrors[i].how; ++k) {
            if (taken[k] || mirrors[k].how) continue;
            mirrors[i] = {k, elastic::MirroredJoint::find(rest, joints[k], joints[i])};
            taken[k] = mirrors[i].how.has_value();
        }
    return mirrors;
}

} // namespace

std::vector<glm::dquat> hingeSamples(const HingeRange& range, const glm::dvec3& pole) {
    const glm::dvec3 axis = glm::normalize(range.axis - pole * glm::dot(range.axis, pole));
    const double flex = range.mostFlexion - range.restFlexion;
    std::vector<glm::dquat> samples;
    addSteps(flex, axis, samples);
    addSteps(range.leastFlexion - range.restFlexion, axis, samples);
    for (const double share : kSidewaysAt)
        for (const double turn : {-kSideways, kSideways})
            samples.push_back(glm::angleAxis(share * flex, glm::angleAxis(turn, pole) * axis));
    for (const double turn : {-kSideways, kSideways})
        samples.push_back(glm::angleAxis(turn, glm::cross(pole, axis)));
    return samples;
}

std::vector<glm::dquat> ballSamples(const glm::dvec3& pole, const glm::dvec3& across, double most) {
    std::vector<glm::dquat> samples;
    const int angles = static_cast<int>(std::ceil(most / kBallStep - 1e-9));
    for (int direction = 0; direction < kDirections; ++direction) {
        const double turn = 2.0 * glm::pi<double>() * direction / kDirections;
        const glm::dvec3 axis = glm::angleAxis(turn, pole) * across;
        for (int i = 1; i <= angles; ++i)
            samples.push_back(glm::angleAxis(most * i / angles, axis));
    }
    return samples;
}

ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const Progress& progress) {
    return solveElasticJoints(skin, {joint}, progress).front();
}

std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const Progress& progress) {
    const std::vector<Mirror> mirrors = mirrorsOf(skin, joints);
    std::vector<std::size_t> toSolve;
    std::size_t whole = 0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (mirrors[i].how) continue;
        toSolve.push_back(i);
        whole += joints[i].samples.size();
    }
    SharedProgress shared(whole);
    std::vector<ElasticShapes> shapes(joints.size());
    shared.tellWhile(progress, [&] {
        parallelFor(toSolve.size(), [&](std::size_t i) {
            shapes[toSolve[i]] = elastic::solveJoint(skin, joints[toSolve[i]], shared);
        });
    });
    for (std::size_t i = 0; i < joints.size(); ++i)
        if (mirrors[i].how) shapes[i] = mirrors[i].how->shapes(shapes[mirrors[i].of]);
    return shapes;
}

} // namespace osgSkin
