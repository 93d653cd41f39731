// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFFILE_H
#define OSGSKINIMPORT_GLTFFILE_H 1

#include "gltf/GltfBuffers.h"

#include <osgSkinImport/ReadLimits>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace osgSkin {

/// A glTF 2 file, text or binary (.gltf, .glb, .vrm), apart in its JSON and its binary chunk.
struct GltfFile {
    std::string path; ///< other files are named relative to its folder
    nlohmann::json json;
    std::optional<std::string> binary; ///< a binary file's chunk, until loadBuffers() takes it
    GltfBuffers buffers;               ///< none before loadBuffers(); as many as of `json` then

    ReadLimits limits;      ///< for the other files
    std::size_t size = 0;   ///< in bytes
    std::size_t beside = 0; ///< bytes of other files that buffers hold

    /// Reads a file.
    /// \throw osgSkin::Error with the place where it cannot be opened, is no glTF 2 or broken as a
    ///        whole
    static GltfFile read(const std::string& path, const ReadLimits& limits);

    /// Adds a buffer; returns its index.
    std::size_t addBuffer(std::string bytes);

    /// The whole file again, as a binary one with a single buffer.
    /// \throw osgSkin::Error where that would be larger than such files can be
    std::string bytes();
};

/// What the JSON library says of a member that is not there or of another kind, without its number.
std::string reasonOf(const nlohmann::json::exception& error);

} // namespace osgSkin

#endif
