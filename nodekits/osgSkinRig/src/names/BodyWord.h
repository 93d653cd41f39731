// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

/// What a word calls a joint. Some words mean one joint in one skeleton and its neighbour in
/// another: those have values of their own, and wordRoles() tells by what else the skeleton names.
enum class BodyWord {
    Hips, ///< with a side: a hip
    Pelvis,
    Spine,
    Neck,
    Head,
    Hip,      ///< the thigh's joint, or what leads to it
    HipJoint, ///< what leads to the thigh, for certain
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
    Finger, ///< which one, its number tells
    Thumb,
    Index,
    Middle,
    Ring,
    Little
};

/// The words that skeletons of people use, joined and in lower case, the longest first.
const std::vector<std::pair<std::string, BodyWord>>& bodyWords();

/// What a whole word, or several joined, calls a joint; nothing where it is none of bodyWords().
std::optional<BodyWord> findBodyWord(const std::string& joined);

/// Whether the word has a left and a right.
bool hasSides(BodyWord word);

/// Words before a part that only say where it is: "leg" before "knee".
bool saysWhere(const std::string& before, BodyWord word);

/// Words that are never part of the prefix which a skeleton's joints share: they make another thing
/// of the joint that they stand before (helpers, controls, clothes, what is held).
bool isForeign(const std::string& word);

} // namespace osgSkin
