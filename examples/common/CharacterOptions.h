// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/ExpectedNames>
#include <osgSkinCharacter/CharacterOption>

#include <CLI/CLI.hpp>

#include <exception>
#include <string>
#include <vector>

namespace example {

/// Adds the options that are also members of `.skin` files (`--shapes`, `--avoid-body`, ...). Their
/// values, descriptions and defaults come from characterOptions().
///
/// \param app receives the options
/// \param options set while `app` parses; must outlive the parsing
inline void addCharacterOptions(CLI::App& app, osgSkin::LoadOptions& options) {
    for (const osgSkin::CharacterOption& option : osgSkin::characterOptions()) {
        if (!option.isMember) continue;
        const auto set = [&options, word = option.word](const std::string& value) {
            try {
                osgSkin::setOption(options, word, value);
            } catch (const std::exception& error) {
                throw CLI::ValidationError(error.what());
            }
        };
        const std::string meaning = option.meaning + " (default: " + option.defaultValue + ")";
        app.add_option_function<std::string>(option.flag(), set, meaning)
            ->type_name(option.values)
            ->group("Options of the character, which override its file's");
    }
}

/// A suggestion for a misspelt option that `app` has refused: "; did you mean \"--shapes\"?", or an
/// empty string.
inline std::string suggestOption(const CLI::App& app) {
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : app.remaining()) {
        const std::string meant = osgSkin::nearestName(word.substr(0, word.find('=')), known);
        if (word.rfind("--", 0) == 0 && !meant.empty()) return "; did you mean \"" + meant + "\"?";
    }
    return {};
}

} // namespace example
