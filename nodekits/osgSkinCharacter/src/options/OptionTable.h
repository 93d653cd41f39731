// SPDX-License-Identifier: MIT
#pragma once

#include "options/JsonReader.h"

#include <osgSkinCharacter/CharacterOption>
#include <osgSkinImport/ReadLimits>

#include <functional>
#include <string>
#include <vector>

namespace osgSkin {

/// A row of the table of options: the texts, and how the option is set.
struct Option : CharacterOption {
    std::vector<std::string> choices; ///< the values, where they are a fixed set
    std::string expected;             ///< description of the values for errors

    /// Returns false where the value is not one of the option's. Empty where ReadLimits::of() reads
    /// the option.
    std::function<bool(LoadOptions&, const std::string& value)> set;

    /// Reads a member of a `.skin` file. Empty where it has one of the `choices`.
    std::function<void(LoadOptions&, const JsonReader&, const ReadLimits&)> read;

    /// Copies the option from `file` where it is not set in `options`. Empty where `set` is.
    std::function<void(LoadOptions& options, const LoadOptions& file)> complete;
};

/// All options, members of `.skin` files first, in the order in which they are read.
const std::vector<Option>& optionTable();

/// Reads a member of a `.skin` file.
/// \throw Error with file, JSON path and what was expected
void readOption(const Option& option, const JsonReader& member, const ReadLimits& limits,
                LoadOptions& options);

/// Copies all options from `file` that are not set in `options`.
void completeOptions(LoadOptions& options, const LoadOptions& file);

} // namespace osgSkin
