// SPDX-License-Identifier: GPL-3.0-or-later
#include "hands/BodySurface.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace osgSkin {
namespace {

/// The mean distance between points that are next to each other.
double spacing(const std::vector<glm::dvec3>& places) {
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < places.size(); ++k)
            if (k != i) nearest = std::min(nearest, glm::distance(places[i], places[k]));
        if (places.size() > 1) sum += nearest;
    }
    return sum / double(places.size());
}

} // namespace

BodySurface::BodySurface(SkinPoints points)
    : _points(std::move(points)), _places(_points.places), _normals(_points.normals) {
    const double length = spacing(_places);
    _softening = std::max(length * length, std::numeric_limits<double>::min());
}

void BodySurface::pose(const PosedJoints& joints) {
    _centre = glm::dvec3(0.0);
    for (std::size_t i = 0; i < _points.size(); ++i) {
        const std::size_t joint = _points.joints[i];
        _places[i] = joints.place(_points.places[i], joint);
        _normals[i] = joints.rotations[joint] * _points.normals[i];
        _centre += _places[i];
    }
    _centre /= double(_points.size());
    double square = 0.0;
    for (const glm::dvec3& place : _places) {
        const glm::dvec3 d = place - _centre;
        square = std::max(square, glm::dot(d, d));
    }
    _radius = std::sqrt(square);
}

bool BodySurface::isNear(const glm::dvec3& place, double margin) const {
    const glm::dvec3 d = place - _centre;
    const double reach = _radius + margin;
    return glm::dot(d, d) < reach * reach;
}

BodySurface::Depth BodySurface::depth(const glm::dvec3& place) const {
    double weights = 0.0, depth = 0.0;
    glm::dvec3 out(0.0);
    for (std::size_t i = 0; i < _places.size(); ++i) {
        const glm::dvec3 d = _places[i] - place;
        // By the eighth power of the distance: the far side of the body does not count.
        double weight = 1.0 / (glm::dot(d, d) + _softening);
        weight *= weight;
        weight *= weight;
        weights += weight;
        depth += weight * glm::dot(_normals[i], d);
        out += weight * _normals[i];
    }
    // Beyond the numbers' range nothing is near.
    if (!(weights > 0.0)) return {};
    depth /= weights;
    out /= weights;
    return {depth * glm::dot(out, out), out};
}

} // namespace osgSkin
