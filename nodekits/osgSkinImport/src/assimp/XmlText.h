// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_XMLTEXT_H
#define OSGSKINIMPORT_ASSIMP_XMLTEXT_H

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace osgSkin {

/// A part of an XML file, to read or to replace.
struct XmlValue {
    std::size_t begin = 0, size = 0;

    std::string_view of(std::string_view xml) const { return xml.substr(begin, size); }
};

/// Finds the value of an attribute of the element whose start tag begins at `tag`.
std::optional<XmlValue> findAttribute(std::string_view xml, std::size_t tag, std::string_view name);

/// Changes of a text: from a place on, how many characters to replace, and by what.
using TextEdits = std::map<std::size_t, std::pair<std::size_t, std::string>>;

void applyEdits(const TextEdits& edits, std::string& text);

} // namespace osgSkin

#endif
