// SPDX-License-Identifier: MIT
#pragma once

#include "bounds/JointMotions.h"
#include "model/BoundsProxy.h"

namespace osgSkin {

/// Boxes of a block's pieces, [axis].
struct BlendedBlock {
    BoundsProxy::Lanes low[3], high[3];
};

/// Boxes of a skin's pieces in a plain pose by linear blending, with what vertices may stray from
/// that (BoundsProxy), by the best instruction set that the processor has.
///
/// \param proxy of the pose's model
/// \param motions the pose's
/// \param boxes one for each block
void blendBoxes(const BoundsProxy& proxy, const JointMotions& motions,
                BlendedBlock* boxes) noexcept;

} // namespace osgSkin
