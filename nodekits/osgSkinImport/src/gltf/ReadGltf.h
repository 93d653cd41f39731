// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_READGLTF_H
#define OSGSKINIMPORT_GLTF_READGLTF_H

#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Reads a glTF file (.gltf, .glb, .vrm or .vrma).
/// \throw osgSkin::Error with the file and the position in it, if it is not glTF 2, violates the
///        specification, or uses unsupported compression
SourceScene readGltf(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
