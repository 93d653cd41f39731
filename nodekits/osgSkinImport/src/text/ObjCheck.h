// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OBJCHECK_H
#define OSGSKINIMPORT_OBJCHECK_H 1

#include <string>

namespace osgSkin {

/// Checks the vertices and faces of an OBJ file before tinyobjloader parses it.
///
/// tinyobjloader reads what is no number as 0, reads "12abc" as 12, drops faces with too few
/// corners and passes on indices beyond the vertices. None of that gets past here.
/// \throw osgSkin::Error "PATH: line N: what was expected".
void checkObj(const std::string& path, const std::string& text);

} // namespace osgSkin

#endif
