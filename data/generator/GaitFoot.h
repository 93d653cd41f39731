// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowArm.h"
#include "ThrowPose.h"
#include "ThrowSpline.h"

#include <functional>
#include <vector>

namespace mannequin {

/// Where a shoe touches the floor at rest, and its joints. The right foot mirrors x.
struct ShoeShape {
    explicit ShoeShape(const Skeleton& skeleton);

    glm::dvec3 ankle, ball; ///< joints of the left foot
    glm::dvec3 heel, tip;   ///< ends of the part of the left sole that is flat on the floor
};

/// A foot relative to the point below the hips, which moves evenly.
struct FootPlacement {
    glm::dvec3 ankle{0};
    double pitch = 0;   ///< degrees; positive with the heel up
    double toeBend = 0; ///< degrees; 0 in line with the foot, positive towards the shin
};

/// A key of the leg in the air: angles in degrees.
struct SwingKey {
    double phase;
    double thigh; ///< of the thigh from the vertical, forward
    double knee;  ///< flexion
};

/// A foot through a cycle of gait. Phase 0 is its contact; it leaves the floor at `toeOff`.
struct FootCycle {
    double stride; ///< metres
    double toeOff;
    double passes; ///< phase at which the hips are above the ankle
    double across; ///< metres from the middle line to the ankle
    Channel pitch;
    std::vector<SwingKey> swing;
};

/// Computes where the foot of a cycle is.
///
/// On the floor, the pitch alone determines the foot: it rolls over the edge of the heel until it
/// is flat, then over the ball, whose toes stay flat, and at last over the tip of the toes. In the
/// air, the ankle follows a spline through the swing keys, which begins and ends with the speed
/// that it has on the floor.
class FootPath {
public:
    /// \param hip position of the left hip at a phase, relative to the same point
    FootPath(const Skeleton& skeleton, FootCycle cycle,
             const std::function<glm::dvec3(double)>& hip);

    /// The left foot at a phase of any size; the right foot mirrors x.
    FootPlacement at(double phase) const;

private:
    FootPlacement grounded(double phase) const;

    ShoeShape shoe_;
    FootCycle cycle_;
    std::vector<double> times_;
    std::vector<glm::dvec3> points_, slopes_; ///< of the ankle in the air
};

} // namespace mannequin
