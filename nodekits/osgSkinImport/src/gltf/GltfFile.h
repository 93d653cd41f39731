// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFFILE_H
#define OSGSKINIMPORT_GLTFFILE_H 1

#include <osgSkinImport/ReadLimits>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace osgSkin {

/// A glTF 2 file, text or binary (.gltf, .glb, .vrm), apart in its JSON and its binary chunk.
struct GltfFile {
    std::string path; ///< other files are named relative to its folder
    nlohmann::json json;
    std::optional<std::string> binary; ///< of a binary file: what buffer 0 holds, where it has one

    bool isBinary = false;
    ReadLimits limits;    ///< for the other files
    std::size_t size = 0; ///< in bytes

    /// Reads a file. None where it is no glTF 2, or broken as a whole.
    /// \throw osgSkin::Error where the file cannot be opened
    static std::optional<GltfFile> read(const std::string& path, const ReadLimits& limits);

    /// The whole file again, of the kind that it was.
    std::string bytes() const;
};

/// What the JSON library says of a member that is not there or of another kind, without its number.
std::string reasonOf(const nlohmann::json::exception& error);

} // namespace osgSkin

#endif
