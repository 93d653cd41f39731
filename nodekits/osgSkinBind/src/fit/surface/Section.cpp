// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/surface/Section.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgSkin {
namespace {

/// Any two unit vectors that complete a unit normal to a frame.
std::pair<glm::dvec3, glm::dvec3> planeAxes(const glm::dvec3& normal) {
    const glm::dvec3 u = anyPerpendicular(normal);
    return {u, glm::cross(normal, u)};
}

} // namespace

Section::Section(std::vector<glm::dvec3> curve, const glm::dvec3& normal)
    : points(std::move(curve)) {
    const auto [u, v] = planeAxes(normal);
    const glm::dvec3 origin = points.front();
    // Moments of the enclosed area as a fan of triangles from the first corner.
    double sum = 0.0, su = 0.0, sv = 0.0, suu = 0.0, suv = 0.0, svv = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 a = points[i] - origin;
        const glm::dvec3 b = points[(i + 1) % points.size()] - origin;
        girth += glm::distance(a, b);
        const double au = glm::dot(a, u), av = glm::dot(a, v);
        const double bu = glm::dot(b, u), bv = glm::dot(b, v);
        const double twice = au * bv - bu * av;
        sum += twice / 2.0;
        su += twice * (au + bu) / 6.0;
        sv += twice * (av + bv) / 6.0;
        suu += twice * (au * au + au * bu + bu * bu) / 12.0;
        svv += twice * (av * av + av * bv + bv * bv) / 12.0;
        suv += twice * (2.0 * au * av + au * bv + bu * av + 2.0 * bu * bv) / 24.0;
    }
    area = std::abs(sum);
    if (!(area > 0.0)) {
        centre = origin;
        return;
    }
    const double cu = su / sum, cv = sv / sum;
    centre = origin + cu * u + cv * v;
    const double uu = suu / sum - cu * cu, vv = svv / sum - cv * cv, uv = suv / sum - cu * cv;
    const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv);
    widest = std::cos(angle) * u + std::sin(angle) * v;
    const double mean = 0.5 * (uu + vv), spread = std::hypot(0.5 * (uu - vv), uv);
    elongation = mean > spread ? std::sqrt((mean + spread) / (mean - spread))
                               : std::numeric_limits<double>::infinity();
}

double Section::low(int axis) const {
    double result = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : points) result = std::min(result, p[axis]);
    return result;
}

double Section::high(int axis) const {
    double result = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : points) result = std::max(result, p[axis]);
    return result;
}

double Section::distance(const glm::dvec3& point, const glm::dvec3& normal) const {
    double nearest = std::numeric_limits<double>::infinity();
    double winding = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3& a = points[i];
        const glm::dvec3& b = points[(i + 1) % points.size()];
        const glm::dvec3 edge = b - a;
        const double length2 = glm::dot(edge, edge);
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(point - a, edge) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::distance(point, a + t * edge));
        const glm::dvec3 pa = a - point, pb = b - point;
        winding += std::atan2(glm::dot(normal, glm::cross(pa, pb)), glm::dot(pa, pb));
    }
    constexpr double kPi = 3.141592653589793;
    return std::abs(winding) > kPi ? -nearest : nearest;
}

} // namespace osgSkin
