// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgSkin {

/// The name without what stands before a colon or bar, in lower case, its letters and digits only:
/// how names of a family are compared.
std::string plainName(const std::string& name);

/// The name's words without prefix ("mixamorig:", "Bip01 ", "DEF-") and side, in lower case,
/// joined: "hand" for "LeftHand", "hand_l" and "Bip01 L Hand". A word ends at a separator, at a
/// digit and where a capital starts the next one; digits are a word too: "Hand1" is "hand1".
std::string bareName(const std::string& name);

/// Whether `name` contains `part`, letters' case ignored; `part` in lower case.
bool nameContains(const std::string& name, const char* part);

} // namespace osgSkin
