// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OBJCHECK_H
#define OSGSKINIMPORT_OBJCHECK_H 1

#include <set>
#include <string>
#include <string_view>

namespace osgSkin {

/// What is left of an OBJ file.
struct CheckedObj {
    std::string text; ///< the lines that were checked, in their order and with their own digits
    std::set<std::string> materials; ///< that it uses, called as checkMtl() calls them
    std::size_t colouredVertices = 0;
    std::size_t weightedVertices = 0; ///< with a fourth number, alone, that is not 1
};

struct CheckedMtl {
    std::string text;
    std::size_t placedTextures = 0; ///< that are moved or scaled (-o, -s), which nothing here does
};

/// Checks the vertices, faces and materials of an OBJ file before tinyobjloader parses it.
///
/// tinyobjloader reads what is no number as 0, reads "12abc" as 12, drops faces with too few
/// corners, passes on indices beyond the vertices, and takes what memory tags ask for. None of that
/// gets past here. A line ends with LF, CR or both.
/// \throw osgSkin::Error "PATH: line N: what was expected".
CheckedObj checkObj(const std::string& path, std::string_view text);

/// The same of a library of materials, where nothing is refused: lines with a keyword that is used,
/// and numbers that are some.
/// \param wanted names of materials: others are left out, and each is taken off when it is found
CheckedMtl checkMtl(std::string_view text, std::set<std::string>& wanted);

} // namespace osgSkin

#endif
