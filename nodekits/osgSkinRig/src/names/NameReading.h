// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_NAMES_NAMEREADING_H
#define OSGSKINRIG_NAMES_NAMEREADING_H

#include "names/NameWords.h"

#include <osgSkinRig/RestSkeleton>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

enum class Side { None, Left, Right };

/// The suffix and numbering that nearly all names of one skeleton share.
struct NameHabits {
    std::string suffix;   ///< last word of nearly all names; empty: none
    bool counted = false; ///< nearly all names end with a number of their own ("Hips_01")

    /// Finds them in the words of all joints' names.
    explicit NameHabits(const std::vector<std::vector<std::string>>& names);
    NameHabits() = default;
};

/// One joint's name, parsed: prefix, side, part of the body and numbers, with the side at any
/// position and with any separators or none.
struct NameReading {
    std::string prefix; ///< the words before part and side, joined, without numbers
    bool foreign =
        false; ///< a word of the prefix says that this is no part of the body; see isAccessory()
    Side side = Side::None;
    BodyWord word = BodyWord::Hips;
    std::vector<std::string> numbers; ///< after the part, in order
};

/// Reads a name.
/// \param words of it, as nameWords() gives them
/// \param habits of its skeleton's names
/// \return nothing where it does not end with a part of the body, or the side does not match the
///        part
std::optional<NameReading> readName(const std::vector<std::string>& words,
                                    const NameHabits& habits = {});

/// Roles of joints by the words in their names. What "shoulder", "arm", "leg" and "hip" mean
/// depends on the other words on the same side, or on the order of joints with the same name.
/// \return [joint] roles as in JointNames, empty for none; several joints may have the same
std::vector<std::string> limbRoles(const RestSkeleton& skeleton,
                                   const std::vector<std::optional<NameReading>>& readings);

} // namespace osgSkin

#endif
