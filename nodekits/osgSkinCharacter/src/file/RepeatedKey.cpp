// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/RepeatedKey.h"

#include <nlohmann/json.hpp>

#include <set>
#include <vector>

namespace osgSkin {
namespace {

/// The byte behind a string's closing quote.
/// \param at of the opening one
std::size_t endOfString(const std::string& text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return at + 1;
}

/// The same for all ways to spell a key: "\u0061" is "a".
std::string meaning(const std::string& quoted) {
    const bool isPlain = quoted.find('\\') == std::string::npos;
    return isPlain ? quoted : nlohmann::json::parse(quoted).dump();
}

} // namespace

std::optional<RepeatedKey> RepeatedKey::find(const std::string& text) {
    std::vector<std::set<std::string>> open; // keys so far, of lists none
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '{' || c == '[') open.emplace_back();
        if ((c == '}' || c == ']') && !open.empty()) open.pop_back();
        if (c != '"') {
            ++i;
            continue;
        }
        const std::size_t end = endOfString(text, i), next = text.find_first_not_of(" \t\r\n", end);
        if (next != std::string::npos && text[next] == ':' && !open.empty() &&
            !open.back().insert(meaning(text.substr(i, end - i))).second)
            return RepeatedKey{text.substr(i + 1, end - i - 2), i};
        i = end;
    }
    return std::nullopt;
}

} // namespace osgSkin
