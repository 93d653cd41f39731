// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowSpline.h"

namespace mannequin {

/// Pelvis, thorax and head in world space: metres and degrees.
///
/// The throw goes towards +X, the viewer stands at +Z. A yaw of 0 faces +Z, 90 faces +X. `leanX`
/// and `leanZ` tilt the upright axis towards +X and +Z.
struct BodyKeys {
    Channel x, y, z; ///< of the joint Hips
    Channel pelvisYaw, pelvisLeanX, pelvisLeanZ;
    Channel thoraxYaw, thoraxLeanX, thoraxLeanZ; ///< of the joint Spine1
    Channel headYaw, headNod, headRoll; ///< nod: chin down, roll: towards the right shoulder
};

/// An arm in clinical angles, degrees. See ArmAngles.
struct ArmKeys {
    Channel protraction, elevation, tilt;
    Channel abduction, horizontal, external;
    Channel elbow, pronation, wrist, fingers, thumb;
};

/// A foot in world space: where its ball is, and how it is turned. See FootTarget.
struct FootKeys {
    Channel x, z, lift, yaw, heel, kneeOut;
};

BodyKeys bodyKeys();
ArmKeys throwingArmKeys(); ///< the right arm
ArmKeys gloveArmKeys();    ///< the left arm
FootKeys pivotFootKeys();  ///< the right foot
FootKeys leadFootKeys();   ///< the left foot

} // namespace mannequin
