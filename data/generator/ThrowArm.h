// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

enum class Side { Right, Left };

/// The direction of the side along X: +1 for left, -1 for right.
constexpr double sign(Side side) {
    return side == Side::Left ? 1.0 : -1.0;
}

/// Joint angles of an arm in degrees. The shoulder's angles follow Dillman et al. (1993), in the
/// trunk's frame.
struct ArmAngles {
    double protraction = 0; ///< shoulder girdle forward
    double elevation = 0;   ///< shoulder girdle up
    double tilt = 0;        ///< shoulder girdle tipped back; part of the external rotation
    double abduction = 0;   ///< upper arm away from straight down
    double horizontal = 0;  ///< horizontal adduction: 0 sideways, 90 forward, negative behind
    double external = 0;    ///< external rotation: forearm 0 forward, 90 up, 180 back (abducted 90)
    double elbow = 0;       ///< flexion, 0 straight
    double pronation = 0;   ///< 0 with the thumb in the plane of the elbow's flexion
    double wrist = 0;       ///< flexion; negative values extend
    double fingers = 0;     ///< curl of each of the two finger joints
    double thumb = 0;       ///< towards the palm
};

/// Directions of an arm in the trunk's frame (left, up, forward): along the upper arm, and the one
/// in which the elbow flexes.
struct ArmDirections {
    glm::dvec3 upper, bend;
};

ArmAngles armAngles(const ArmKeys& keys, double time);

/// Sets the rotations of one arm, from the girdle to the fingers.
/// \pre the trunk is posed
void poseArm(const Skeleton& skeleton, Side side, const ArmAngles& angles, Pose& pose);

/// The same, with the upper arm in given directions in place of the shoulder's angles.
/// \pre the trunk is posed
void poseArm(const Skeleton& skeleton, Side side, const ArmAngles& angles,
             const ArmDirections& directions, Pose& pose);

/// Measures abduction, horizontal adduction, external rotation and elbow flexion from the
/// positions of the joints; the other angles are 0. The elbow is negative if it bends backward.
ArmAngles measureArm(const Skeleton& skeleton, Side side, const WorldPose& world);

/// Centre of a ball in the hand, in the rest pose.
glm::dvec3 gripAtRest(const Skeleton& skeleton, Side side);

constexpr double kBallRadius = 0.037; ///< metres; a baseball

} // namespace mannequin
