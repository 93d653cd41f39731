// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgSkin {

/// Checks that the header of a PLY file has an end: Assimp 5.2.5 searches for it for ever.
/// \throw osgSkin::Error "PATH: what was expected".
void checkPly(const std::string& path, const std::string& text);

} // namespace osgSkin
