// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_READGLTF_H
#define OSGSKINIMPORT_GLTF_READGLTF_H

#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Whether a file name has a glTF extension: .gltf, .glb, .vrm or .vrma.
bool isGltfName(const std::string& path);

/// Reads a glTF file; see isGltfName().
/// \throw osgSkin::Error with the file and the position in it, if it is not glTF 2, violates the
///        specification, or uses unsupported compression
SourceScene readGltf(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
