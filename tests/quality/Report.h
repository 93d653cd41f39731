// SPDX-License-Identifier: MIT
#pragma once

#include "BindFigures.h"
#include "CappingCost.h"
#include "Continuity.h"
#include "Format.h"
#include "PoseFigures.h"
#include "Rigidity.h"
#include "WristTwist.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <ostream>

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

/// The limits that hold for every body with default settings.
std::vector<Bar> bars(const Report& report);

void printTable(const Report& report, std::ostream& out);
nlohmann::ordered_json toJson(const Report& report);

} // namespace quality
