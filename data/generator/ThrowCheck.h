// SPDX-License-Identifier: MIT
#pragma once

#include "BvhWriter.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// Checks the properties of a written throw and its ball that the demo relies on. Prints each
/// result.
/// \return true if every check passes
bool checkThrow(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& body,
                const std::vector<BvhRow>& ball);

} // namespace mannequin
