// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_IMPORT_SHARESCENES_H
#define OSGSKINIMPORT_IMPORT_SHARESCENES_H

#include "scene/SourceScene.h"

#include <osgDB/Options>

#include <memory>
#include <string>

namespace osgSkin {

/// Throws osgSkin::Error for a file whose format has not what is wanted, or the reason why it
/// cannot be opened (requireReadable()).
[[noreturn]] void refuse(const std::string& path, const ReadLimits& limits,
                         const std::string& message);

/// Reads a file by our glTF reader or by Assimp, or returns the scene that `options` share
/// (shareScenes()).
///
/// \throw osgSkin::Error with the file and the reason
std::shared_ptr<const SourceScene> readSourceScene(const std::string& path,
                                                   const osgDB::Options* options);

} // namespace osgSkin

#endif
