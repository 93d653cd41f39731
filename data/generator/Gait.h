// SPDX-License-Identifier: MIT
#pragma once

#include "GaitFoot.h"

namespace mannequin {

/// A value that swings once or twice a cycle, greatest at the phase `peak`.
struct Swing {
    double mean, amplitude, peak;

    double at(double phase, int times = 1) const;
};

/// A gait towards +Z. Phases count from the left foot's contact; the right side is half a cycle
/// behind. Lengths in metres, angles in degrees.
struct Gait {
    double seconds; ///< of a cycle
    double stride;
    FootCycle foot;
    double hipsHeight;        ///< mean height of the joint Hips
    Swing rise, surge;        ///< of the hips, twice a cycle: up and ahead
    Swing sway;               ///< of the hips, to the left
    Swing turn, list, tilt;   ///< of the pelvis: left side back, left side up, forward (twice)
    Swing counterTurn, lean;  ///< of the thorax: left side back; forward (twice)
    Swing side;               ///< of the thorax: to the left
    Swing nod;                ///< of the head, chin down (twice)
    Swing arm, elbow, girdle; ///< of the left arm: forward, flexion, shoulder forward
    double spread;            ///< of the upper arm, away from the trunk
    double inward;            ///< of the forearm: how far across the body the elbow flexes
    double fingers;           ///< curl of each joint
};

/// A brisk walk: 1.4 m/s.
Gait walk();

/// An easy run: 3.2 m/s.
Gait run();

/// Poses a gait.
class GaitMotion {
public:
    GaitMotion(const Skeleton& skeleton, Gait gait);

    const Gait& gait() const { return gait_; }

    /// The pose at a time in seconds; each cycle goes on where the one before ended.
    Pose poseAt(double time) const;

private:
    /// The pose at a phase without its limbs, above the point that moves evenly.
    Pose trunkAt(double phase) const;

    const Skeleton& skeleton_;
    Gait gait_;
    FootPath path_;
};

} // namespace mannequin
