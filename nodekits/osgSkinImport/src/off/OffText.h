// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OFFTEXT_H
#define OSGSKINIMPORT_OFFTEXT_H 1

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

/// What the first word of an OFF file, [ST][C][N][4][n]OFF, says of vertices.
struct OffKind {
    bool texCoords = false, colours = false, normals = false, divided = false, dimensions = false;

    /// False where a word is none.
    bool read(std::string_view word);
};

/// An OFF file's words and lines. Comments run from "#" to the line's end; a line ends with LF, CR
/// or both.
class OffText {
public:
    explicit OffText(std::string_view text);

    /// The next word, of whatever line; empty at the end.
    std::string_view word();

    /// The words of the next line that has some, or what is left of the one that word() is in.
    const std::vector<std::string_view>& line();

private:
    void skip(std::string_view characters);

    std::string_view _rest;
    std::vector<std::string_view> _words;
};

} // namespace osgSkin

#endif
