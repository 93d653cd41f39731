// SPDX-License-Identifier: MIT
#pragma once

#include "core/Four.h"
#include "model/BoundsProxy.h"

#include <osgSkin/Pose>

namespace osgSkin {

/// What bounds need of a joint in a pose, in single precision: BoundsProxy::rounding is for that.
struct JointMotion {
    FourMap map;         ///< G
    Four translation;    ///< the root's is in its map
    float bend;          ///< psi
    float twist;         ///< |phi|
    float square;        ///< of their sum
    float signedTwist;   ///< phi
    float cosine, sine;  ///< of the bend axis, from e1 to e2
    float scale, scaled; ///< its own, and that less 1
    float travel;        ///< by how much it is translated; of the root 0
    float scaling;       ///< its own scale's difference from 1
    float growth;        ///< its own scale, at least 1
    float growthHere;    ///< the product of the growths of this joint and those above it
};

/// A box, three lanes each.
struct FourBox {
    Four low, high;
};

/// The box that holds a posed skin, by the best instruction set that the processor has.
///
/// \param proxy of the pose's model
/// \param pose of the model's joints
/// \param room for as many as the pose has joints, and at least PoseAccess::kAtOnce
/// \param weights CorrectiveStray's; null where there are no correctives
FourBox boxOf(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
              const float* weights) noexcept;

} // namespace osgSkin
