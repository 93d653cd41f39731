// SPDX-License-Identifier: MIT
#pragma once

#include "Methods.h"

namespace quality {

/// The largest step of any vertex while one joint turns by a degree, over that of a rigid arc: the
/// way the vertex would go if it followed the joint wholly.
struct Sweep {
    double worst = 0.0;
    std::string joint; ///< where that is
};

struct Continuity {
    PerMethod<Sweep> bend, twist;
};

/// Sweeps each joint singly over -179..179 degrees of bend, about two axes, and of twist.
Continuity measureContinuity(const Subject& subject);

/// The largest step of ours in bends, about four axes each, of the joints that correctives shape.
Sweep measureShapedBends(const Subject& subject);

} // namespace quality
