// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_ASSIMPSCENE_H
#define OSGSKINIMPORT_ASSIMP_ASSIMPSCENE_H

#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Reads a file by Assimp without post-processing: nothing is triangulated, joined or reordered.
///
/// \param path of a file whose extension Assimp has a reader for
/// \param limits on its size and depth
/// \throw osgSkin::Error with the file and Assimp's reason
SourceScene readAssimpScene(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
