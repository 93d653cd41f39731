// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OFFCHECK_H
#define OSGSKINIMPORT_OFFCHECK_H 1

#include <string>

namespace osgSkin {

/// Checks counts, vertices and faces of an OFF file: Assimp 5.2.5 asks for the memory before it
/// reads on, and counts faces that are none off more than there are.
/// \return what Assimp reads rightly: without a byte order mark, numbers of many digits, and normals
///         where colours or texture coordinates follow them
/// \throw osgSkin::Error "PATH: what was expected".
std::string checkOff(const std::string& path, const std::string& text);

} // namespace osgSkin

#endif
