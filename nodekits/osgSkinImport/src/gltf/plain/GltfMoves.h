// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFMOVES_H
#define OSGSKINIMPORT_GLTFMOVES_H 1

#include "gltf/plain/GltfParts.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace osgSkin {

/// What moves nodes of a glTF file, checked: its animations with their channels and samplers.
class GltfMoves {
public:
    /// \param parts must outlive this; its accessors have been checked
    /// \param path of the file, for errors; must outlive this
    GltfMoves(GltfParts& parts, const std::string& path);

    /// Adds them to a checked file.
    void check(nlohmann::json& result);

private:
    /// Assimp looks for each channel's node by its name, one by one.
    void checkChannels() const;
    void tell() const;

    GltfParts& _parts;
    const std::string& _path;
    std::size_t _channels = 0;   ///< of all animations
    std::size_t _movedTwice = 0; ///< channels whose node and path one before has
    std::string _otherPath;      ///< the first that a channel has and none knows
};

} // namespace osgSkin

#endif
