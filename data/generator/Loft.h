// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace mannequin {

/// Directions in which a loft's sections are given.
struct LoftFrame {
    glm::dvec3 origin;
    glm::dvec3 axis; ///< unit
    glm::dvec3 u;    ///< unit, orthogonal to the axis
    glm::dvec3 v;    ///< unit, orthogonal to both

    /// Frame whose `u` is the part of `uHint` that is orthogonal to `axis`.
    static LoftFrame make(const glm::dvec3& origin, const glm::dvec3& axis,
                          const glm::dvec3& uHint);
};

/// A cross-section: four quarters of superellipses about a centre.
struct LoftSection {
    double t;                ///< place along the axis
    double centreU, centreV; ///< centre, off the axis
    double plusU, minusU;    ///< radii toward +u and -u
    double plusV, minusV;    ///< radii toward +v and -v
    double power;            ///< 2 gives an ellipse, more a squarer outline
};

/// Solid through a row of cross-sections, cut off flat (its ends lie inside other solids).
///
/// Anatomical tables give breadths, depths and girths at heights, which is what sections state.
class Loft {
public:
    Loft(const LoftFrame& frame, const std::vector<LoftSection>& sections);

    /// Estimate of the signed distance, exact on the surface.
    double distance(const glm::dvec3& point) const;

private:
    using Channels = std::array<double, 7>;

    Channels interpolated(double t) const;

    LoftFrame _frame;
    std::vector<double> _t;
    std::vector<Channels> _values;
    std::vector<Channels> _slopes;
};

} // namespace mannequin
