// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/Muscles.h"

#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Cosines of the angle to the belly's side: from kBesides on, skin begins to lie over a muscle
/// that wraps around its line, and from kOver on it lies fully over it.
constexpr double kBesides = -0.25;
constexpr double kOver = 0.9;

/// The same of the angle between the skin's normal and the side, for a flat muscle: skin that faces
/// elsewhere lies over another one.
constexpr double kFacesAway = 0.0;
constexpr double kFaces = 0.6;

/// A belly is as round as sin^kRoundness: over most of the line, and flat where its tendons begin.
constexpr double kRoundness = 1.6;

/// The share of a muscle's reach in which skin lies fully over it.
constexpr double kNear = 0.7;

/// Skin moves along its normal, which inflates it, and by this share along the belly's side, which
/// lifts it to a crest.
constexpr double kLift = 0.6;

/// Rounds of thicknessFor().
constexpr int kRounds = 12;

/// Thickness of a belly along its line, 0 outside 0..1, at most 1.
double bellyAt(double place, double peak) {
    if (!(place > 0.0 && place < 1.0)) return 0.0;
    const double warped = std::pow(place, std::log(0.5) / std::log(peak));
    return std::pow(std::sin(glm::pi<double>() * warped), kRoundness);
}

} // namespace

MuscleSkin::MuscleSkin(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                       const JointRatios& ratios, const Muscle& muscle) {
    const double length = glm::length(muscle.insertion - muscle.origin);
    _along = (muscle.insertion - muscle.origin) / length;
    _belly = muscle.origin + muscle.peak * length * _along;
    const glm::dvec3 across = glm::cross(muscle.side, _along);
    // How far the skin at d from the origin lies over the muscle, apart from along its line.
    const auto overAt = [&](const glm::dvec3& d, const glm::dvec3& normal, double place) {
        const glm::dvec3 fromLine = d - place * length * _along;
        const double distance = glm::length(fromLine);
        double over = 1.0;
        if (!muscle.isOfLimb())
            over = 1.0 - hermiteRatio((distance / muscle.reach - kNear) / (1.0 - kNear));
        if (!muscle.isFlat()) {
            const double cosine =
                distance > 0.0 ? glm::dot(fromLine, muscle.side) / distance : -1.0;
            return over * hermiteRatio((cosine - kBesides) / (kOver - kBesides));
        }
        const double width =
            glm::mix(muscle.widthAtOrigin, muscle.widthAtInsertion, glm::clamp(place, 0.0, 1.0));
        const double aside = std::min(1.0, std::abs(glm::dot(fromLine, across)) / width);
        const double cosine = std::cos(glm::half_pi<double>() * aside);
        const double facing = glm::dot(normal, muscle.side);
        return over * cosine * cosine * hermiteRatio((facing - kFacesAway) / (kFaces - kFacesAway));
    };
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> indexOf(mesh.vertexCount(), kNone);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        const glm::dvec3 d = mesh.positions[v] - muscle.origin;
        const double place = glm::dot(d, _along) / length;
        double over = overAt(d, mesh.normals[v], place) * bellyAt(place, muscle.peak) *
                      (1.0 - ratios.rigid(v, joints));
        if (muscle.isOfLimb()) {
            const double limb = ratios.bend(v, muscle.above) * (1.0 - ratios.bend(v, muscle.hinge));
            if (!(limb > 0.0)) continue;
            over *= limb;
        } else if (!(over > 0.0)) {
            continue;
        }
        indexOf[v] = static_cast<std::uint32_t>(_vertices.size());
        _vertices.push_back(v);
        _positions.push_back(mesh.positions[v]);
        const glm::dvec3 way = mesh.normals[v] + kLift * muscle.side;
        const double size = glm::length(way);
        _swelling.push_back(size > 0.0 ? over / size * way : glm::dvec3(0.0));
    }
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
        if (indexOf[t[0]] != kNone && indexOf[t[1]] != kNone && indexOf[t[2]] != kNone)
            _triangles.push_back({indexOf[t[0]], indexOf[t[1]], indexOf[t[2]]});
}

double MuscleSkin::thicknessFor(double growth) const {
    const double before = girth(0.0);
    if (!(before > 0.0) || !(growth > 0.0)) return 0.0;
    double thickness = growth * before;
    for (int round = 0; round < kRounds; ++round) {
        const double grown = girth(thickness) / before - 1.0;
        if (!(grown > 1e-3 * growth)) return 0.0;
        thickness *= growth / grown;
    }
    return thickness;
}

double MuscleSkin::girth(double thickness) const {
    double girth = 0.0;
    for (const std::array<std::uint32_t, 3>& t : _triangles) {
        glm::dvec3 corners[3];
        double heights[3];
        for (std::size_t c = 0; c < 3; ++c) {
            corners[c] = _positions[t[c]] + thickness * _swelling[t[c]];
            heights[c] = glm::dot(corners[c] - _belly, _along);
        }
        glm::dvec3 cuts[2];
        int found = 0;
        for (int c = 0; c < 3 && found < 2; ++c) {
            const int next = (c + 1) % 3;
            if ((heights[c] < 0.0) == (heights[next] < 0.0)) continue;
            const double share = heights[c] / (heights[c] - heights[next]);
            cuts[found++] = corners[c] + share * (corners[next] - corners[c]);
        }
        if (found == 2) girth += glm::length(cuts[1] - cuts[0]);
    }
    return girth;
}

} // namespace osgSkin
