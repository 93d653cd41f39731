// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_NAMES_NAMEWORDS_H
#define OSGSKINRIG_NAMES_NAMEWORDS_H

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

/// Normalises a name for comparison within a family: without namespace (before a colon or bar), in
/// lower case, letters and digits only. Letters beyond ASCII are kept as they are.
std::string plainName(const std::string& name);

/// The name's words, in lower case. A word ends at a separator, at a digit and where a capital
/// starts the next one; a run of digits is a word too: "L_HandIndex01" is l, hand, index, 01.
///
/// Tools' additions are left out: namespaces ("mixamorig:", "Armature|", "a/b"),
/// notes in brackets ("NPC Head [Head]") and the codes that FBX exporters write for signs
/// ("FBXASC046" for a dot).
std::vector<std::string> nameWords(const std::string& name);

/// The words without prefix ("mixamorig:", "Bip01 ", "DEF-") and side, joined: "hand" for
/// "LeftHand", "hand_l" and "Bip01 L Hand", but "hand1" for "Hand1".
std::string bareName(const std::string& name);

/// Whether a node is one that Assimp makes of an FBX joint's pivots ("Hips_$AssimpFbx$_Rotation"),
/// which its exporters turn into joints. It is no part of the body and has no nameWords().
bool isPivot(const std::string& name);

/// The parts of a text between separators.
std::vector<std::string> split(const std::string& text, char separator = ' ');

/// Whether a word is a number.
bool isNumber(const std::string& word);

/// Whether `name` contains `part` in either case; `part` is in lower case.
bool nameContains(const std::string& name, const char* part);

/// The meaning of a word in a joint's name. Some words mean one joint in one skeleton and its
/// neighbour in another: these have values of their own, which limbRoles() resolves.
enum class BodyWord {
    Hips, ///< with a side: a hip
    Pelvis,
    Spine,
    Neck,
    Head,
    Hip,      ///< the thigh's joint, or the one above it
    HipJoint, ///< certainly the joint above the thigh
    Thigh,
    Leg, ///< the thigh, or the shin below a thigh
    Shin,
    Foot,
    Toe,
    Collar,
    Shoulder, ///< the collar bone, or the upper arm's joint
    UpperArm,
    Arm, ///< the upper arm, or the forearm below an upper arm
    ForeArm,
    Hand,
    FingerBase,
    Fingers,
    Finger, ///< its number says which one
    Thumb,
    Index,
    Middle,
    Ring,
    Little
};

/// The words that skeletons of people use, joined and in lower case, the longest first.
const std::vector<std::pair<std::string, BodyWord>>& bodyWords();

/// The meaning of one word or several joined ones; nothing where it is not one of bodyWords().
std::optional<BodyWord> findBodyWord(const std::string& joined);

/// Whether the word has a left and a right.
bool hasSides(BodyWord word);

/// Words before a part that only locate it: "leg" before "knee".
bool isPositional(const std::string& before, BodyWord word);

/// Words that are never part of a skeleton's common prefix: a joint behind them is no part of the
/// body (helpers, controls, clothes, held things).
bool isAccessory(const std::string& word);

} // namespace osgSkin

#endif
