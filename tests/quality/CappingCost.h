// SPDX-License-Identifier: MIT
#pragma once

#include "PoseFigures.h"
#include "WristTwist.h"

#include <string>

namespace quality {

/// What it costs that a vertex follows few joints in part: the largest share by which any figure of
/// the motions or of a twisted wrist is worse than with as many as the deformation takes.
struct CappingCost {
    double share = 0.0;
    std::string figure; ///< where that is
};

/// \param capped the subject's own figures
/// \param wrist the subject's own, too
CappingCost measureCapping(const Subject& subject, const std::vector<NamedPose>& poses,
                           const PoseFigures& capped, const std::vector<WristTwist>& wrist);

} // namespace quality
