// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"

#include <ostream>

namespace quality {

/// Prints a body's figures for people to read.
void printTable(const Report& report, std::ostream& out);

} // namespace quality
