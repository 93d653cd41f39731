// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowSpline.h"

namespace mannequin {

// Sources of the keyed angles:
//   G. S. Fleisig, S. W. Barrentine, N. Zheng, R. F. Escamilla, J. R. Andrews, "Kinematic and
//   kinetic comparison of baseball pitching among various levels of development", J. Biomech. 32
//   (1999) 1371-1375. C. J. Dillman, G. S. Fleisig, J. R. Andrews, "Biomechanics of pitching with
//   emphasis upon shoulder kinematics", J. Orthop. Sports Phys. Ther. 18 (1993) 402-408. R. F.
//   Escamilla, G. S. Fleisig, S. W. Barrentine, N. Zheng, J. R. Andrews, "Kinematic comparisons of
//   throwing different types of baseball pitches", J. Appl. Biomech. 14 (1998) 1-23.

/// Pelvis, thorax and head in world space: metres and degrees.
///
/// The throw goes towards +X, the viewer stands at +Z. A yaw of 0 faces +Z, 90 faces +X. `leanX`
/// and `leanZ` tilt the upright axis towards +X and +Z.
struct BodyKeys {
    Channel x, y, z; ///< of the joint Hips
    Channel pelvisYaw, pelvisLeanX, pelvisLeanZ;
    Channel thoraxYaw, thoraxLeanX, thoraxLeanZ; ///< of the joint Spine1
    Channel headYaw, headNod, headRoll; ///< nod is chin down, roll is towards the right shoulder
};

/// An arm in clinical angles, degrees. See ArmAngles.
struct ArmKeys {
    Channel protraction, elevation, tilt;
    Channel abduction, horizontal, external;
    Channel elbow, pronation, wrist, fingers, thumb;
};

/// A foot in world space: the position of its ball, and its orientation. See FootTarget.
struct FootKeys {
    Channel x, z, lift, yaw, heel, kneeOut;
};

} // namespace mannequin
