// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowMeasure.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// Prints the achieved angles and the published ones side by side.
void printReport(std::ostream& out, const std::vector<FrameMeasure>& frames, const Launch& launch);

} // namespace mannequin
