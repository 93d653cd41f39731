// SPDX-License-Identifier: MIT
#include "Primitives.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {

double smoothMin(double a, double b, double width) {
    const double overlap = std::max(width - std::abs(a - b), 0.0);
    return std::min(a, b) - (width > 0 ? overlap * overlap / (4 * width) : 0);
}

double smoothMax(double a, double b, double width) {
    return -smoothMin(-a, -b, width);
}

glm::dvec3 mirrored(const glm::dvec3& point) {
    return {-point.x, point.y, point.z};
}

double RoundCone::distance(const glm::dvec3& point) const {
    const glm::dvec3 axis = to - from;
    const double length = glm::length(axis);
    const double narrowing = fromRadius - toRadius;
    if (length <= std::abs(narrowing)) // one ball contains the other
        return narrowing > 0 ? glm::distance(point, from) - fromRadius
                             : glm::distance(point, to) - toRadius;
    const double along = glm::dot(point - from, axis) / length;
    const double across = glm::length(point - from - axis * (along / length));
    const double sine = narrowing / length;
    const double cosine = std::sqrt(1 - sine * sine);
    // Position along the axis of the closest point on the slanted side.
    const double foot = along - across * sine / cosine;
    if (foot <= 0) return std::hypot(along, across) - fromRadius;
    if (foot >= length) return std::hypot(along - length, across) - toRadius;
    return across * cosine + along * sine - fromRadius;
}

double Ellipsoid::distance(const glm::dvec3& point) const {
    const glm::dvec3 local = (point - centre) * axes; // transpose(axes) * (point - centre)
    const double value = glm::length(local / radii);
    const double slope = glm::length(local / (radii * radii));
    if (slope < 1e-12) return -std::min({radii.x, radii.y, radii.z});
    return value * (value - 1) / slope;
}

glm::dmat3 rotation(double x, double y, double z) {
    const glm::dmat4 one(1);
    return glm::dmat3(glm::rotate(one, glm::radians(z), glm::dvec3(0, 0, 1)) *
                      glm::rotate(one, glm::radians(y), glm::dvec3(0, 1, 0)) *
                      glm::rotate(one, glm::radians(x), glm::dvec3(1, 0, 0)));
}

} // namespace mannequin
