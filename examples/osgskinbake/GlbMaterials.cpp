// SPDX-License-Identifier: GPL-3.0-or-later
#include "GlbMaterials.h"

#include "ImageBytes.h"

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;

int wrapOf(osg::Texture::WrapMode mode) {
    if (mode == osg::Texture::REPEAT) return 10497;
    return mode == osg::Texture::MIRROR ? 33648 : 33071; // else the edge goes on
}

/// The roughness of a highlight as wide as Blinn's.
float roughnessOf(const SurfaceMaterial& material) {
    const osg::Vec4& s = material.specular;
    if (std::max({s.r(), s.g(), s.b()}) <= 0.0f) return 1.0f;
    return std::pow(2.0f / (std::max(material.shininess, 0.0f) + 2.0f), 0.25f);
}

} // namespace

GlbMaterials::GlbMaterials(GlbBuffer& buffer, std::string folder)
    : _buffer(buffer), _folder(std::move(folder)) {}

std::optional<std::size_t> GlbMaterials::image(const osg::Image& image) {
    const auto known = _known.find(&image);
    if (known != _known.end()) return known->second;
    const std::optional<ImageBytes> bytes = bytesOf(image, _folder);
    std::optional<std::size_t> index;
    if (bytes) {
        // Materials may have read one file each for themselves.
        const auto file = _files.find(bytes->file);
        if (file != _files.end() && !bytes->file.empty()) {
            index = file->second;
        } else {
            index = _images.size();
            _images.push_back({{"bufferView", _buffer.addFile(bytes->data)},
                               {"mimeType", bytes->isJpeg ? "image/jpeg" : "image/png"}});
            _files[bytes->file] = *index;
        }
    }
    _known[&image] = index;
    return index;
}

std::size_t GlbMaterials::sampler(const SurfaceMaterial& material) {
    const nlohmann::json sampler{{"magFilter", kLinear},
                                 {"minFilter", kLinearMipmapLinear},
                                 {"wrapS", wrapOf(material.wrapS)},
                                 {"wrapT", wrapOf(material.wrapT)}};
    const auto found = std::find(_samplers.begin(), _samplers.end(), sampler);
    if (found != _samplers.end()) return static_cast<std::size_t>(found - _samplers.begin());
    _samplers.push_back(sampler);
    return _samplers.size() - 1;
}

std::optional<std::size_t> GlbMaterials::texture(const SurfaceMaterial& material) {
    if (!material.image) return std::nullopt;
    const std::optional<std::size_t> source = image(*material.image);
    if (!source) return std::nullopt;
    const nlohmann::json texture{{"source", *source}, {"sampler", sampler(material)}};
    const auto found = std::find(_textures.begin(), _textures.end(), texture);
    if (found != _textures.end()) return static_cast<std::size_t>(found - _textures.begin());
    _textures.push_back(texture);
    return _textures.size() - 1;
}

std::size_t GlbMaterials::add(const SurfaceMaterial& material, const std::string& name) {
    const osg::Vec4 base = linear(material.diffuse), light = linear(material.emission);
    const auto unit = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
    nlohmann::json pbr{
        {"baseColorFactor", {unit(base.r()), unit(base.g()), unit(base.b()), unit(base.a())}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", roughnessOf(material)}};
    if (const auto index = texture(material)) pbr["baseColorTexture"] = {{"index", *index}};
    nlohmann::json entry{{"name", name}, {"pbrMetallicRoughness", pbr}};
    if (light.r() + light.g() + light.b() > 0.0f)
        entry["emissiveFactor"] = {unit(light.r()), unit(light.g()), unit(light.b())};
    if (material.twoSided) entry["doubleSided"] = true;
    if (material.alpha == SurfaceMaterial::Alpha::Blend) entry["alphaMode"] = "BLEND";
    if (material.alpha == SurfaceMaterial::Alpha::Mask) {
        entry["alphaMode"] = "MASK";
        entry["alphaCutoff"] = material.alphaCutOff;
    }
    _materials.push_back(entry);
    return _materials.size() - 1;
}

void GlbMaterials::finish(nlohmann::json& root) const {
    root["materials"] = _materials;
    if (_textures.empty()) return;
    root["textures"] = _textures;
    root["images"] = _images;
    root["samplers"] = _samplers;
}

} // namespace bake
