// SPDX-License-Identifier: MIT
#pragma once

#include "CrossSections.h"

namespace quality {

/// Both hands, one after the other, twisted about their poles; the worse of the two.
struct WristTwist {
    double degrees = 0.0;
    PerMethod<double> strain;                  ///< RMS over the edges that change their length
    PerMethod<CrossSections::Least> leastArea; ///< of the forearm's cross-sections
};

/// At 60, 120 and 170 degrees. Empty where the rig has no hands.
std::vector<WristTwist> measureWristTwists(const Subject& subject);

} // namespace quality
