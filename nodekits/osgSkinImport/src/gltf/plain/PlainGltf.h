// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PLAINGLTF_H
#define OSGSKINIMPORT_PLAINGLTF_H 1

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// A glTF 2 file in the words that Assimp reads rightly: nodes with names of their own, floats for
/// quantised numbers, linear tracks, skins with their inverse bind matrices.
struct PlainGltf {
    std::string bytes;           ///< of the whole file, a binary one
    bool facesBackwards = false; ///< the figure's front is -Z, not +Z
};

/// Whether files of this name are glTF: .gltf, .glb or .vrm.
bool isGltfName(const std::string& path);

/// Reads a file that isGltfName().
/// \throw osgSkin::Error with the file and the place in it where it is none, breaks the
///        specification, or is compressed in a way that is not read
PlainGltf plainGltf(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
