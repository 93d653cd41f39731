// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgSkin {

/// The name without what stands before a colon or bar, in lower case, its letters and digits only:
/// how names of a family are compared. Letters beyond ASCII are kept as they are.
std::string plainName(const std::string& name);

/// The name's words, in lower case. A word ends at a separator, at a digit and where a capital
/// starts the next one; a run of digits is a word too: "L_HandIndex01" is l, hand, index, 01.
///
/// What tools put around a name is no part of it: namespaces ("mixamorig:", "Armature|", "a/b"),
/// notes in brackets ("NPC Head [Head]") and the codes that FBX exporters write for signs
/// ("FBXASC046" for a dot).
std::vector<std::string> nameWords(const std::string& name);

/// The words without prefix ("mixamorig:", "Bip01 ", "DEF-") and side, joined: "hand" for
/// "LeftHand", "hand_l" and "Bip01 L Hand", but "hand1" for "Hand1".
std::string bareName(const std::string& name);

/// Whether a node is one of those that Assimp makes of an FBX joint's pivots, and its exporters
/// joints ("Hips_$AssimpFbx$_Rotation"): no part of the body, and nameWords() are none.
bool isPivot(const std::string& name);

/// Whether a word is a number.
bool isNumber(const std::string& word);

/// Whether `name` contains `part`, letters' case ignored; `part` in lower case.
bool nameContains(const std::string& name, const char* part);

} // namespace osgSkin
