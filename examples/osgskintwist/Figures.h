// SPDX-License-Identifier: MIT
#pragma once

#include "Comparison.h"

#include <SkinMeasures.h>

namespace twist {

/// What a pose does to the cylinder, each against the rest pose.
struct Figures {
    double volume = 1.0;    ///< V'/V
    double leastArea = 1.0; ///< smallest A'/A of the cross-sections along the limb
    double jointArea = 1.0; ///< A'/A at the joint, where the peers' weights are a half each
    double bulge = 1.0;     ///< largest distance to the posed bones over that to the rest bones
    compare::EdgeStrain strain;
};

/// Measures deformed copies of one cylinder.
class FigureMaker {
public:
    explicit FigureMaker(const Cylinder& cylinder);

    /// \param posed the cylinder's vertices under `pose`
    Figures measure(const std::vector<glm::dvec3>& posed, const TwistPose& pose) const;

private:
    const Cylinder& _cylinder;
    std::vector<std::uint32_t> _triangles;
    std::vector<compare::Edge> _edges;
    std::vector<std::uint32_t> _side; ///< every vertex of a ring
};

/// What linear blending leaves of a cross-section at half weight under `pose`, in closed form:
/// cos^2(theta / 2) for a twist by theta, cos(theta / 2) for a bend.
double linearBlendJointArea(const TwistPose& pose);

} // namespace twist
