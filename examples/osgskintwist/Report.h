// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

namespace twist {

/// Prints the three methods' figures over a set of poses as a table, and how near linear blending
/// comes to its closed form at the joint.
void printReport(std::ostream& out);

} // namespace twist
