// SPDX-License-Identifier: MIT
#pragma once

#include "points/Four.h"

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

} // namespace osgSkin
