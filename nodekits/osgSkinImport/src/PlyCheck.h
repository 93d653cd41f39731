// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgSkin {

/// Checks the header of a PLY file: Assimp 5.2.5 searches for a missing end for ever, and believes
/// any number of elements.
/// \throw osgSkin::Error "PATH: what was expected".
void checkPly(const std::string& path, const std::string& text);

} // namespace osgSkin
