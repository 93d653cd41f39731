// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFLOOKS_H
#define OSGSKINIMPORT_GLTFLOOKS_H 1

#include "gltf/plain/GltfParts.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// What surfaces of a glTF file look like, checked: materials, textures, samplers and images.
class GltfLooks {
public:
    /// \param parts must outlive this; its buffers have been checked
    explicit GltfLooks(const GltfParts& parts);

    /// Adds them to a checked file.
    void check(nlohmann::json& result) const;

private:
    /// Adds the images, those of the same bytes once.
    /// \return for each image of the file its place among them
    std::vector<std::size_t> addImages(nlohmann::json& result) const;
    nlohmann::json textureInfo(const nlohmann::json& from, const std::string& where) const;
    /// A texture of emission: not drawn, but as the colour of a surface that is black without.
    void glow(const nlohmann::json& from, const std::string& where, nlohmann::json& result) const;
    nlohmann::json material(const nlohmann::json& from, const std::string& where) const;

    const GltfParts& _parts;
};

} // namespace osgSkin

#endif
