// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/Muscles.h"

#include "regions/HermiteRatio.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Cosines of the angle to the belly's side: from kBesides on, skin begins to lie over the muscle,
/// and from kOver on it lies fully over it.
constexpr double kBesides = -0.35;
constexpr double kOver = 0.85;

/// The part of the limb where its radius is measured, in fractions of the bone.
constexpr double kMiddleFrom = 0.35;
constexpr double kMiddleTo = 0.65;

/// Thickness of a spindle along its length, 0 outside 0..1.
double thickness(double t) {
    if (!(t > 0.0 && t < 1.0)) return 0.0;
    const double s = std::sin(glm::pi<double>() * t);
    return s * s;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

MuscleSkin::MuscleSkin(const WeldedMesh& mesh, const JointRatios& ratios, Muscle& muscle) {
    const double length = glm::length(muscle.end - muscle.begin);
    _along = (muscle.end - muscle.begin) / length;
    _belly = muscle.begin + 0.5 * (muscle.from + muscle.to) * length * _along;
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> indexOf(mesh.vertexCount(), kNone);
    std::vector<double> radii;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        const double limb =
            ratios.bend(v, muscle.above) * (1.0 - ratios.bend(v, muscle.functions.joint));
        if (!(limb > 0.0)) continue;
        const glm::dvec3 d = mesh.positions[v] - muscle.begin;
        const double fraction = glm::dot(d, _along) / length;
        const glm::dvec3 across = d - _along * glm::dot(d, _along);
        const double radius = glm::length(across);
        if (fraction > kMiddleFrom && fraction < kMiddleTo && limb > 0.5) radii.push_back(radius);
        const double cosine = radius > 0.0 ? glm::dot(across, muscle.side) / radius : 0.0;
        indexOf[v] = static_cast<std::uint32_t>(_vertices.size());
        _vertices.push_back(v);
        _positions.push_back(mesh.positions[v]);
        _normals.push_back(mesh.normals[v]);
        _place.push_back((fraction - muscle.from) / (muscle.to - muscle.from));
        _weight.push_back(limb * hermiteRatio((cosine - kBesides) / (kOver - kBesides)));
    }
    muscle.radius = median(std::move(radii));
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
        if (indexOf[t[0]] != kNone && indexOf[t[1]] != kNone && indexOf[t[2]] != kNone)
            _triangles.push_back({indexOf[t[0]], indexOf[t[1]], indexOf[t[2]]});
}

MuscleSkin::Heights MuscleSkin::spindle(double length) const {
    Heights heights;
    for (std::size_t i = 0; i < _vertices.size(); ++i)
        heights.push_back(_weight[i] * (thickness((_place[i] - 0.5) / length + 0.5) / length -
                                        thickness(_place[i])));
    return heights;
}

double MuscleSkin::girth(const Heights& lifted) const {
    double girth = 0.0;
    for (const std::array<std::uint32_t, 3>& t : _triangles) {
        glm::dvec3 corners[3];
        double heights[3];
        for (int c = 0; c < 3; ++c) {
            corners[c] = at(t[std::size_t(c)], lifted);
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

double MuscleSkin::volume(const Heights& lifted) const {
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : _triangles)
        volume += glm::dot(at(t[0], lifted) - _belly,
                           glm::cross(at(t[1], lifted) - _belly, at(t[2], lifted) - _belly)) /
                  6.0;
    return volume;
}

} // namespace osgSkin
