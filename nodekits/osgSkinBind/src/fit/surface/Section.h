// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SECTION_H
#define OSGSKINBIND_FIT_SECTION_H

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// One closed curve in which a plane cuts the skin.
struct Section {
    std::vector<glm::dvec3> points; ///< the curve's corners; the first is not repeated
    glm::dvec3 centre{0.0};         ///< centroid of the enclosed area
    double area = 0.0;
    double girth = 0.0;      ///< length of the curve
    glm::dvec3 widest{0.0};  ///< unit; direction in the plane in which the area spreads most
    double elongation = 1.0; ///< spread along `widest` over the spread across it, at least 1

    /// \param curve the corners, without the first one repeated
    /// \param normal unit; the plane's normal
    Section(std::vector<glm::dvec3> curve, const glm::dvec3& normal);

    /// Least and greatest coordinate (0 x, 1 y, 2 z) of the curve.
    double low(int axis) const;
    double high(int axis) const;

    /// Distance from a point of the plane to the curve; negative inside.
    double distance(const glm::dvec3& point, const glm::dvec3& normal) const;
};

} // namespace osgSkin

#endif
