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
    std::size_t weightedVertices = 0; ///< with a fourth number of 4 or 7 that is not 1
};

/// Checks the vertices, faces and materials of an OBJ file before tinyobjloader parses it.
///
/// tinyobjloader reads what is no number as 0, reads "12abc" as 12, drops faces with too few
/// corners, passes on indices beyond the vertices, and takes what memory tags ask for. None of that
/// gets past here. A line ends with LF, CR or both.
/// \throw osgSkin::Error "PATH: line N: what was expected".
CheckedObj checkObj(const std::string& path, std::string_view text);

} // namespace osgSkin

#endif
