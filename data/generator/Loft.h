// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace mannequin {

/// The coordinate frame of a loft's cross-sections.
struct LoftFrame {
    glm::dvec3 origin;
    glm::dvec3 axis; ///< unit
    glm::dvec3 u;    ///< unit, orthogonal to the axis
    glm::dvec3 v;    ///< unit, orthogonal to both

    /// Makes a frame whose `u` is the component of `uHint` orthogonal to `axis`.
    static LoftFrame make(const glm::dvec3& origin, const glm::dvec3& axis,
                          const glm::dvec3& uHint);
};

/// A cross-section made of four quarter superellipses around a centre.
struct LoftSection {
    double t;                ///< position along the axis
    double centreU, centreV; ///< offset of the centre from the axis
    double plusU, minusU;    ///< radii toward +u and -u
    double plusV, minusV;    ///< radii toward +v and -v
    double power;            ///< 2 is an ellipse, higher values are squarer
};

/// A solid through a series of cross-sections. Its ends are flat and lie inside other solids.
///
/// Cross-sections match anatomical tables, which list breadths, depths and girths by height.
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
