// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "GlbBuffer.h"
#include "SurfaceMaterial.h"

#include <osg/Image>

#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <string>

namespace bake {

/// The materials of a glTF file, with the textures and the embedded images that they need.
class GlbMaterials {
public:
    /// \param folder where file names of images are relative to
    GlbMaterials(GlbBuffer& buffer, std::string folder);

    /// Adds a material. Returns its index.
    std::size_t add(const SurfaceMaterial& material, const std::string& name);

    /// Puts what was added into the file's description.
    void finish(nlohmann::json& root) const;

private:
    std::optional<std::size_t> texture(const SurfaceMaterial& material);
    std::optional<std::size_t> image(const osg::Image& image);
    std::size_t sampler(const SurfaceMaterial& material);

    GlbBuffer& _buffer;
    std::string _folder;
    nlohmann::json _materials = nlohmann::json::array();
    nlohmann::json _textures = nlohmann::json::array();
    nlohmann::json _images = nlohmann::json::array();
    nlohmann::json _samplers = nlohmann::json::array();
    std::map<const osg::Image*, std::optional<std::size_t>> _known;
    std::map<std::string, std::size_t> _files;
};

} // namespace bake
