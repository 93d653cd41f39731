// SPDX-License-Identifier: MIT
#pragma once

#include "CylinderFigures.h"

#include <nlohmann/json.hpp>

#include <ostream>

namespace quality {

/// The cylinder's figures for people, and for programs, to read.
void printTable(const std::vector<CylinderPose>& poses, std::ostream& out);
nlohmann::ordered_json toJson(const std::vector<CylinderPose>& poses);

} // namespace quality
