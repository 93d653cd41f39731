// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_IMPORT_SHARESCENES_H
#define OSGSKINIMPORT_IMPORT_SHARESCENES_H

#include "scene/SourceScene.h"

#include <osgDB/Options>

#include <memory>
#include <string>

namespace osgSkin {

/// Whether there is a reader for scenes in files with this name's extension.
bool hasSceneReader(const std::string& path);

/// Whether files with this name's extension hold meshes and nothing that would move them. Assimp is
/// not asked for a rig in them: it reads PLY files out of bounds, and loses memory of OBJ files.
bool holdsMeshesOnly(const std::string& path);

/// Reads a file by the reader of its format, or takes what `options` carry of it (shareScenes()).
///
/// \throw osgSkin::Error with the file and the reason
std::shared_ptr<const SourceScene> readSourceScene(const std::string& path,
                                                   const osgDB::Options* options);

} // namespace osgSkin

#endif
