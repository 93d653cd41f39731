// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowMeasure.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// Prints the achieved angles beside the published ones.
void printReport(std::ostream& out, const std::vector<FrameMeasure>& frames, const Launch& launch);

} // namespace mannequin
