// SPDX-License-Identifier: MIT
#pragma once

#include "BindFigures.h"
#include "CappingCost.h"
#include "Continuity.h"
#include "PoseFigures.h"
#include "Rigidity.h"
#include "WristTwist.h"

#include <optional>
#include <string>

namespace quality {

/// Every figure of one body.
struct Report {
    std::string body;
    std::size_t vertices = 0, poses = 0;
    PerMethod<PoseFigures> motion;
    std::vector<LimbRigidity> rigidity;
    std::vector<WristTwist> wrist;
    std::optional<Continuity> continuity; ///< takes longest; may be left out
    BindFigures binding;
    CappingCost capping;
};

} // namespace quality
