// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_IMPORT_SHARESCENES_H
#define OSGSKINIMPORT_IMPORT_SHARESCENES_H

#include "scene/SourceScene.h"

#include <osgDB/Options>

#include <memory>
#include <string>

namespace osgSkin {

/// Whether there is a scene reader for this file extension.
bool hasSceneReader(const std::string& path);

/// Whether files with this extension contain meshes only, with no skeleton or animation. These
/// files are never given to Assimp to look for a rig: its PLY reader reads out of bounds, and its
/// OBJ reader leaks memory.
bool holdsMeshesOnly(const std::string& path);

/// Reads a file with the reader for its format, or returns the scene that `options` share
/// (shareScenes()).
///
/// \throw osgSkin::Error with the file and the reason
std::shared_ptr<const SourceScene> readSourceScene(const std::string& path,
                                                   const osgDB::Options* options);

} // namespace osgSkin

#endif
