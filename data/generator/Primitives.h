// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace mannequin {

/// Minimum of two distances, smoothed where they differ by less than `width`.
double smoothMin(double a, double b, double width);

/// Maximum of two distances, smoothed where they differ by less than `width`.
double smoothMax(double a, double b, double width);

/// A point mirrored in the plane of symmetry, x = 0.
glm::dvec3 mirrored(const glm::dvec3& point);

/// Convex hull of two balls.
struct RoundCone {
    glm::dvec3 from, to;
    double fromRadius, toRadius;

    double distance(const glm::dvec3& point) const;
};

/// Ellipsoid; the columns of `axes` are its unit axes.
struct Ellipsoid {
    glm::dvec3 centre, radii;
    glm::dmat3 axes = glm::dmat3(1);

    /// First-order estimate, exact on the surface.
    double distance(const glm::dvec3& point) const;
};

/// Rotation by angles in degrees, first about x, then y, then z.
glm::dmat3 rotation(double x, double y, double z);

} // namespace mannequin
