// SPDX-License-Identifier: MIT
#pragma once

#include "names/BodyWord.h"

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

enum class Side { None, Left, Right };

/// What all names of one skeleton have besides the joint's own words.
struct NameHabits {
    std::string suffix;   ///< last word of nearly all names; empty: none
    bool counted = false; ///< nearly all names end with a number of their own ("Hips_01")

    /// Learns them from the words of all joints' names.
    explicit NameHabits(const std::vector<std::vector<std::string>>& names);
    NameHabits() = default;
};

/// One joint's name as it reads: prefix, side, part of the body and numbers, in whatever order the
/// side stands, and with whatever separators, or none.
struct NameReading {
    std::string prefix;   ///< what stands before part and side, joined, without numbers
    bool foreign = false; ///< a word of the prefix says that this is another thing; see isForeign()
    Side side = Side::None;
    BodyWord word = BodyWord::Hips;
    std::vector<std::string> numbers; ///< after the part, in order
};

/// Reads a name.
/// \param words of it, as nameWords() gives them
/// \param habits of its skeleton's names
/// \return nothing where it does not end with a part of the body, or one that has two sides is
///         without any, or the reverse
std::optional<NameReading> readName(const std::vector<std::string>& words,
                                    const NameHabits& habits = {});

} // namespace osgSkin
