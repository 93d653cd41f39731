// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"

#include <nlohmann/json.hpp>

namespace quality {

/// A body's figures for programs to read.
nlohmann::ordered_json toJson(const Report& report);

} // namespace quality
