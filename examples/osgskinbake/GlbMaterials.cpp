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
float roughnessOf(const SurfaceLook& look) {
    const osg::Vec4& s = look.specular;
    if (std::max({s.r(), s.g(), s.b()}) <= 0.0f) return 1.0f;
    return std::pow(2.0f / (std::max(look.shininess, 0.0f) + 2.0f), 0.25f);
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

std::size_t GlbMaterials::sampler(const SurfaceLook& look) {
    const nlohmann::json sampler{{"magFilter", kLinear},
                                 {"minFilter", kLinearMipmapLinear},
                                 {"wrapS", wrapOf(look.wrapS)},
                                 {"wrapT", wrapOf(look.wrapT)}};
    const auto found = std::find(_samplers.begin(), _samplers.end(), sampler);
    if (found != _samplers.end()) return static_cast<std::size_t>(found - _samplers.begin());
    _samplers.push_back(sampler);
    return _samplers.size() - 1;
}

std::optional<std::size_t> GlbMaterials::texture(const SurfaceLook& look) {
    if (!look.image) return std::nullopt;
    const std::optional<std::size_t> source = image(*look.image);
    if (!source) return std::nullopt;
    const nlohmann::json texture{{"source", *source}, {"sampler", sampler(look)}};
    const auto found = std::find(_textures.begin(), _textures.end(), texture);
    if (found != _textures.end()) return static_cast<std::size_t>(found - _textures.begin());
    _textures.push_back(texture);
    return _textures.size() - 1;
}

std::size_t GlbMaterials::add(const SurfaceLook& look, const std::string& name) {
    const osg::Vec4 base = linear(look.diffuse), light = linear(look.emission);
    const auto share = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
    nlohmann::json surface{
        {"baseColorFactor", {share(base.r()), share(base.g()), share(base.b()), share(base.a())}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", roughnessOf(look)}};
    if (const auto index = texture(look)) surface["baseColorTexture"] = {{"index", *index}};
    nlohmann::json material{{"name", name}, {"pbrMetallicRoughness", surface}};
    if (light.r() + light.g() + light.b() > 0.0f)
        material["emissiveFactor"] = {share(light.r()), share(light.g()), share(light.b())};
    if (look.twoSided) material["doubleSided"] = true;
    if (look.alpha == SurfaceLook::Alpha::Blend) material["alphaMode"] = "BLEND";
    if (look.alpha == SurfaceLook::Alpha::Mask) {
        material["alphaMode"] = "MASK";
        material["alphaCutoff"] = look.alphaCutOff;
    }
    _materials.push_back(material);
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
