// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PLYCHECK_H
#define OSGSKINIMPORT_PLYCHECK_H 1

#include <string>

namespace osgSkin {

/// Checks a PLY file's header, and its lists' lengths: Assimp 5.2.5 searches for a missing end for
/// ever, and believes any number of elements and entries.
/// \throw osgSkin::Error "PATH: what was expected".
void checkPly(const std::string& path, const std::string& text);

} // namespace osgSkin

#endif
