// SPDX-License-Identifier: MIT
#include "assimp/XmlText.h"

#include <cctype>
#include <utility>

namespace osgSkin {

std::optional<XmlValue> findAttribute(std::string_view xml, std::size_t tag,
                                      std::string_view name) {
    const std::string_view start = xml.substr(0, xml.find_first_of("<>", tag + 1));
    for (auto at = start.find(name, tag); at != start.npos; at = start.find(name, at + 1)) {
        const std::size_t sign = start.find_first_not_of(" \t\r\n", at + name.size());
        if (sign == start.npos || start[sign] != '=' ||
            std::isspace(static_cast<unsigned char>(start[at - 1])) == 0)
            continue;
        const std::size_t quote = start.find_first_not_of(" \t\r\n", sign + 1);
        if (quote == start.npos || (start[quote] != '"' && start[quote] != '\'')) continue;
        const std::size_t close = start.find(start[quote], quote + 1);
        if (close != start.npos) return XmlValue{quote + 1, close - quote - 1};
    }
    return std::nullopt;
}

void applyEdits(const TextEdits& edits, std::string& text) {
    std::string result;
    std::size_t copied = 0;
    for (const auto& [at, edit] : edits) {
        if (at < copied) continue; // within what is removed
        result.append(text, copied, at - copied).append(edit.second);
        copied = at + edit.first;
    }
    text = std::move(result.append(text, copied));
}

} // namespace osgSkin
