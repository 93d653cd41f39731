// SPDX-License-Identifier: MIT
#pragma once

#include "core/Four.h"
#include "model/BoundsProxy.h"

#include <osgSkin/Pose>

namespace osgSkin {

/// A joint's motion in a pose, in single precision (see BoundsProxy::rounding).
struct JointMotion {
    FourMap map;         ///< G
    Four translation;    ///< the root's is in its map
    float bend;          ///< psi
    float twist;         ///< |phi|
    float square;        ///< of their sum
    float signedTwist;   ///< phi
    float cosine, sine;  ///< of the bend axis, from e1 to e2
    float scale, scaled; ///< its own, and that less 1
    float travel;        ///< the length of its translation; 0 for the root
    float scaling;       ///< its own scale's difference from 1
    float growth;        ///< its own scale, at least 1
    float growthHere;    ///< the product of the growths of this joint and those above it
};

/// A box, three lanes each.
struct Box4 {
    Four low, high;
};

/// The box around a posed skin.
///
/// \param proxy of the pose's model
/// \param room one for each joint of the pose, and at least PoseAccess::kAtOnce
/// \param weights CorrectiveDisplacementBound's; null without correctives
Box4 boxOf(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
           const float* weights) noexcept;

} // namespace osgSkin
