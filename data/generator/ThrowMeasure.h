// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

#include <glm/vec3.hpp>

#include <vector>

namespace mannequin {

/// Measurements of one frame in degrees, taken from the posed joints alone.
struct FrameMeasure {
    double abduction, horizontal, external, elbow; ///< of the throwing arm, see ArmAngles
    double rightKnee, leftKnee;                    ///< flexion
    double leftElbow;
    double pelvisYaw, thoraxYaw;  ///< 0 facing +Z, 90 facing the target
    double tiltForward, tiltSide; ///< of the line from the hips to the neck: to +X and to -Z
    double rightSole, leftSole;   ///< lowest height of the sole, metres
    glm::dvec3 rightToe, leftToe; ///< joint ToeBase
    glm::dvec3 leftAnkle, rightAnkle;
};

std::vector<FrameMeasure> measureFrames(const Skeleton& skeleton, const std::vector<Pose>& poses);

/// Frames at which the rotation of each segment is fastest, in the order of the published
/// kinematic sequence, and the speeds in degrees per second.
struct Sequence {
    int pelvis, thorax, elbow, shoulder;
    double pelvisSpeed, thoraxSpeed, elbowSpeed, shoulderSpeed;
};

Sequence kinematicSequence(const std::vector<FrameMeasure>& frames);

/// The ball's direction of flight.
struct Launch {
    double speed;    ///< metres per second
    double up;       ///< degrees above the horizontal
    double sideways; ///< degrees off the target, positive towards +Z
};

Launch launchOf(const glm::dvec3& velocity);

} // namespace mannequin
