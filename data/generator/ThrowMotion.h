// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowArm.h"
#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

/// The throw as a function of time.
class ThrowMotion {
public:
    explicit ThrowMotion(const Skeleton& skeleton);

    Pose poseAt(double time) const;

    /// Centre of a ball in the throwing hand.
    glm::dvec3 gripAt(double time) const;

    /// Velocity of that centre, metres per second.
    glm::dvec3 gripVelocityAt(double time) const;

private:
    const Skeleton& skeleton_;
    BodyKeys body_;
    ArmKeys throwing_, glove_;
    FootKeys pivot_, lead_;
};

/// Centre of a ball in the throwing hand of a posed figure.
glm::dvec3 grip(const Skeleton& skeleton, const WorldPose& world);

} // namespace mannequin
