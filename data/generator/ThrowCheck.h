// SPDX-License-Identifier: MIT
#pragma once

#include "BvhWriter.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// Checks a written throw and its ball for what the demo relies on, and prints each finding.
/// \return whether all hold
bool checkThrow(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& body,
                const std::vector<BvhRow>& ball);

} // namespace mannequin
