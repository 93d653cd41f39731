// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OBJLINES_H
#define OSGSKINIMPORT_OBJLINES_H 1

#include "text/ByteOrderMark.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace osgSkin {

/// Of a material, or of a file: what is behind is left out.
constexpr std::size_t kLongestName = 4000;

/// Takes the next line off `text`; it ends with LF, CR, both, or a 0.
std::string_view takeLine(std::string_view& text);

/// Takes the next word off `line`; empty at its end.
std::string_view takeWord(std::string_view& line);

std::string_view trimmed(std::string_view text);

/// A material's name, which may have blanks: tinyobjloader would take a face's for the first word.
std::string materialName(std::string_view rest);

/// Whether tinyobjloader's power of ten stays a number.
bool isInRange(double value);

/// Adds a number as it stands; one that tinyobjloader would overflow at as 0, and one of more
/// digits than it keeps apart in its shortest form.
void addNumber(std::string_view word, double value, std::string& out);

/// What a line of an OBJ file adds one of, in the order of a corner's v/vt/vn; else -1.
constexpr int kindOf(std::string_view keyword) {
    return keyword == "v" ? 0 : keyword == "vt" ? 1 : keyword == "vn" ? 2 : -1;
}

/// Whether a backslash at the end of a line with this keyword goes on with the next.
constexpr bool isContinued(std::string_view keyword) {
    return keyword == "f" || kindOf(keyword) >= 0;
}

/// Calls `use(keyword, rest of the line, line number)` for each line that has a keyword. A
/// backslash at its end, of numbers or corners, goes on with the next.
template <typename Use>
void forEachLine(std::string_view text, const Use& use) {
    text.remove_prefix(byteOrderMark(text));
    std::string joined;
    std::size_t lines = 1;
    for (std::size_t number = 1; !text.empty(); number += lines) {
        std::string_view line = takeLine(text);
        lines = 1;
        std::string_view keyword = takeWord(line);
        const std::size_t last = keyword.empty() ? 0 : keyword.size() - 1;
        if (line.empty() && keyword.substr(last) == "\\" && isContinued(keyword.substr(0, last))) {
            line = keyword.substr(last); // right behind it
            keyword.remove_suffix(1);
        }
        const bool mayGoOn = isContinued(keyword);
        if (mayGoOn && !line.empty() && line.back() == '\\') {
            joined.clear();
            for (; !line.empty() && line.back() == '\\'; ++lines) {
                joined.append(line.substr(0, line.size() - 1)) += ' ';
                line = takeLine(text);
            }
            line = joined.append(line);
        }
        if (!keyword.empty()) use(keyword, line, number);
    }
}

} // namespace osgSkin

#endif
