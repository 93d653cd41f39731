// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SurfaceMaterial.h"

#include <cstddef>
#include <string>
#include <vector>

namespace bake {

/// The material library that goes with OBJ files called `pattern`: without their number and their
/// folder.
std::string libraryName(const std::string& pattern);

/// The name of a surface's material, in OBJ and glTF files.
std::string materialName(std::size_t surface);

/// Writes a material for each surface (.mtl). A texture that was read from a PNG or JPEG file is
/// named from where it is, others are written beside the library.
///
/// \param folder where file names of images are relative to
/// \throw osgSkin::Error where it cannot be written
void writeLibrary(const std::string& file, const std::vector<Surface>& surfaces,
                  const std::string& folder);

} // namespace bake
