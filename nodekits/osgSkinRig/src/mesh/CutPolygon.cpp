// SPDX-License-Identifier: MIT
#include "mesh/CutPolygon.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// How much of a polygon a fan's triangle may fold back over it, for what is all but flat.
constexpr double kFold = 1e-6;

/// How far corners of a flat polygon may be off its plane, of its extent.
constexpr double kBent = 1e-4;

} // namespace

bool PolygonCutter::fanFits(const std::uint32_t* corners, std::uint32_t size) {
    // Scaled to size 1, so that products of lengths neither overflow nor vanish.
    const glm::dvec3& origin = _positions[corners[0]];
    double extent = 0.0;
    for (std::uint32_t k = 1; k < size; ++k) {
        const glm::dvec3 way = glm::abs(_positions[corners[k]] - origin);
        extent = std::max({extent, way.x, way.y, way.z});
    }
    const double scale = extent > 0.0 ? 1.0 / extent : 1.0;
    const auto area = [&](std::uint32_t k) {
        return glm::cross((_positions[corners[k - 1]] - origin) * scale,
                          (_positions[corners[k]] - origin) * scale);
    };
    _normal = glm::dvec3(0.0);
    for (std::uint32_t k = 2; k < size; ++k) _normal += area(k);
    const double least = -kFold * glm::dot(_normal, _normal);
    for (std::uint32_t k = 2; k < size; ++k)
        if (glm::dot(area(k), _normal) < least) return false;
    return true;
}

void PolygonCutter::project(const std::uint32_t* corners, std::uint32_t size) {
    const glm::dvec3& origin = _positions[corners[0]];
    const auto way = [&](std::uint32_t k) { return _positions[corners[k]] - origin; };
    _flat.clear();
    // One that is bent: along its normal, so that it is cut alike however it stands.
    const double length = glm::length(_normal);
    const glm::dvec3 normal = length > 0.0 ? _normal / length : glm::dvec3(0.0);
    glm::dvec3 across(0.0);
    double off = 0.0, extent = 0.0;
    for (std::uint32_t k = 1; k < size; ++k) {
        const double height = glm::dot(way(k), normal);
        const glm::dvec3 level = way(k) - normal * height;
        off = std::max(off, std::abs(height));
        extent = std::max(extent, glm::length(way(k)));
        if (glm::length(level) > glm::length(across)) across = level;
    }
    if (off > kBent * extent && across != glm::dvec3(0.0)) {
        across = glm::normalize(across);
        const glm::dvec3 up = glm::cross(normal, across);
        for (std::uint32_t k = 0; k < size; ++k)
            _flat.emplace_back(glm::dot(way(k), across), glm::dot(way(k), up));
        return;
    }
    // A flat one along the axis that the normal is nearest to, which rounds nothing; turned so that
    // the polygon runs to the left.
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(_normal[k]) > std::abs(_normal[axis])) axis = k;
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    const double side = _normal[axis] < 0.0 ? -1.0 : 1.0;
    for (std::uint32_t k = 0; k < size; ++k) _flat.emplace_back(side * way(k)[right], way(k)[up]);
}

/// Above 0 where three corners turn to the left.
double PolygonCutter::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec2 first = _flat[b] - _flat[a], second = _flat[c] - _flat[a];
    return first.x * second.y - first.y * second.x;
}

bool PolygonCutter::isEar(std::uint32_t corner) {
    const std::uint32_t before = _previous[corner], after = _next[corner];
    if (_looks == 0) return true;
    --_looks;
    if (!(turn(before, corner, after) > 0.0)) return false;
    for (std::uint32_t k = _next[after]; k != before; k = _next[k]) {
        if (_looks == 0) return true;
        --_looks;
        // Holes are cut into polygons along edges there and back, whose corners are there twice.
        if (_flat[k] == _flat[before] || _flat[k] == _flat[corner] || _flat[k] == _flat[after])
            continue;
        if (turn(before, corner, k) >= 0.0 && turn(corner, after, k) >= 0.0 &&
            turn(after, before, k) >= 0.0)
            return false;
    }
    return true;
}

void PolygonCutter::clipEars(std::uint32_t size, std::vector<std::uint32_t>& out) {
    _next.resize(size);
    _previous.resize(size);
    for (std::uint32_t k = 0; k < size; ++k) {
        _next[k] = (k + 1) % size;
        _previous[k] = (k + size - 1) % size;
    }
    std::uint32_t corner = 1, passed = 0;
    for (std::uint32_t left = size; left >= 3;) {
        // What has no ear, crosses itself: some corner is as good as any.
        if (passed < left && !isEar(corner)) {
            corner = _next[corner];
            ++passed;
            continue;
        }
        const std::uint32_t before = _previous[corner], after = _next[corner];
        out.insert(out.end(), {before, corner, after});
        _next[before] = after;
        _previous[after] = before;
        corner = _next[after];
        passed = 0;
        --left;
    }
}

void PolygonCutter::cut(const std::uint32_t* corners, std::uint32_t size,
                        std::vector<std::uint32_t>& out) {
    if (size > 3 && _looks > 0 && !fanFits(corners, size)) {
        project(corners, size);
        clipEars(size, out);
        return;
    }
    for (std::uint32_t k = 2; k < size; ++k) out.insert(out.end(), {0, k - 1, k});
}

} // namespace osgSkin
