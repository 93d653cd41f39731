// SPDX-License-Identifier: MIT
#pragma once

#include "CommandLine.h"

#include <osgSkinCharacter/CharacterOption>

#include <string>

namespace example {

/// Adds the options that are also members of `.skin` files (`--shapes`, `--avoid-body`, ...). Their
/// values, descriptions and defaults come from characterOptions().
///
/// \param line receives the options
/// \param options set while `line` parses; must outlive the parsing
inline void addCharacterOptions(CommandLine& line, osgSkin::LoadOptions& options) {
    for (const osgSkin::CharacterOption& option : osgSkin::characterOptions()) {
        if (!option.isMember) continue;
        const auto set = [&options, word = option.word](const std::string& value) {
            osgSkin::setOption(options, word, value);
        };
        line.add(option.flag(), set, option.meaning + " (default: " + option.defaultValue + ")")
            .describe(option.values, "Options of the character, which override its file's");
    }
}

} // namespace example
