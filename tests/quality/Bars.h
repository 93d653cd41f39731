// SPDX-License-Identifier: MIT
#pragma once

#include "Format.h"
#include "Report.h"

#include <vector>

namespace quality {

/// The limits that hold for every body with default settings.
std::vector<Bar> bars(const Report& report);

} // namespace quality
