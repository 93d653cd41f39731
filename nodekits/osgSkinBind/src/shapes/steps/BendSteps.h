// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BENDSTEPS_H
#define OSGSKINBIND_BENDSTEPS_H

#include "shapes/ShapedJoint.h"

#include <array>
#include <vector>

namespace osgSkin {

/// Steps of one degree that a joint may bend by: about axes all around it, each from one end of
/// what a joint can turn to the other.
class BendSteps {
public:
    using Weights = std::array<double, CorrectiveJoint::kMostModes>;

    /// A bend, and what it scales the modes by.
    struct Bend {
        BendTwist bend;
        Weights weights;
    };

    struct Step {
        Bend from, to;
        glm::dvec3 axis; ///< unit
        bool isInRange;  ///< of what was sampled: the functions' coordinates are not clamped
    };

    /// \param functions the joint's, with modes and coefficients
    BendSteps(const ShapedJoint& joint, const CorrectiveJoint& functions);

    const std::vector<Step>& all() const { return _steps; }

    /// How far a rigid body's points are taken by a step, for each unit of their distance from the
    /// axis.
    static double rigid();

private:
    std::vector<Step> _steps;
};

} // namespace osgSkin

#endif
