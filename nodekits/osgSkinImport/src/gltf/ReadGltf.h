// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_READGLTF_H
#define OSGSKINIMPORT_GLTF_READGLTF_H

#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Whether files of this name are glTF: .gltf, .glb or .vrm.
bool isGltfName(const std::string& path);

/// Reads a file that isGltfName().
/// \throw osgSkin::Error with the file and the place in it where it is no glTF 2, breaks the
///        specification, or is compressed in a way that is not read
SourceScene readGltf(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
