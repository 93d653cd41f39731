// SPDX-License-Identifier: MIT
// The appearance of surfaces in a glTF file: materials, textures, samplers and images.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

namespace osgSkin {
namespace {

using nlohmann::json;

bool isWord(const std::string& text) {
    return text.size() <= 40 && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '/' || c == '-' ||
                      c == '+' || c == '.';
           });
}

/// The file extension for an image's format, from its first bytes, because exporters often write a
/// wrong MIME type or none. For unknown bytes, from the MIME type; empty if there is no reader.
std::string formatOf(std::string_view bytes, const std::string& mime) {
    static const std::pair<std::string_view, const char*> kinds[] = {
        {"\x89PNG", "png"}, {"\xff\xd8\xff", "jpg"}, {"GIF8", "gif"}, {"DDS ", "dds"},
        {"RIFF", "webp"},   {"\xabKTX 2", "ktx2"},   {"BM", "bmp"}};
    for (const auto& [mark, format] : kinds)
        if (bytes.substr(0, mark.size()) == mark) return format;
    const std::size_t slash = mime.find('/');
    if (!isWord(mime) || slash == std::string::npos) return {};
    const std::string format = mime.substr(slash + 1);
    if (format == "jpeg") return "jpg";
    return format.size() <= 3 ? format : "";
}

/// The index of a texture's image, which may be in an extension for other image formats; null if
/// there is none.
const json* sourceOf(const json& texture) {
    const auto own = texture.find("source");
    if (own != texture.end()) return &*own;
    const auto extensions = texture.find("extensions");
    if (extensions == texture.end()) return nullptr;
    for (const json& extension : *extensions)
        if (extension.contains("source")) return &extension.at("source");
    return nullptr;
}

osg::Texture::WrapMode wrapOf(std::size_t mode) {
    constexpr std::size_t kClamp = 33071, kMirror = 33648;
    if (mode == kClamp) return osg::Texture::CLAMP_TO_EDGE;
    return mode == kMirror ? osg::Texture::MIRROR : osg::Texture::REPEAT;
}

class MaterialReader {
public:
    explicit MaterialReader(GltfDocument& document)
        : _document(document), _file(document.file), _accessors(document.accessors) {}

    void run() {
        readImages();
        readTextures();
        _file.forEach("materials", [&](const json& from, const std::string& where) {
            readMaterial(from, where);
        });
        warnUnusedTextures(_file.path, _unused);
    }

private:
    struct Texture {
        GltfIndex image;
        osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    };
    /// A material's reference to one of its textures.
    struct TextureInfo {
        std::size_t texture = 0, texCoord = 0;
        std::optional<GltfTextureTransform> transform;
    };

    void readImages() {
        std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> stored;
        std::size_t bytes = 0;
        _file.forEach("images", [&](const json& from, const std::string& where) {
            GltfImage image;
            const std::string mime = from.value("mimeType", "");
            _imageOf.push_back(_document.images.size());
            if (from.contains("bufferView")) {
                const std::string error =
                    _accessors.viewError(from.at("bufferView"), 0, 0, 0, true);
                if (!error.empty()) _file.fail(where, error);
                const auto number = from.at("bufferView").get<std::size_t>();
                const GltfAccessors::View& view = _accessors.view(number);
                const auto [found, isNew] =
                    stored.insert({{view.buffer, view.offset, view.length}, _imageOf.back()});
                _imageOf.back() = found->second;
                if (!isNew) return; // same bytes as an earlier image
                bytes += view.length;
                if (bytes > _file.allBytes())
                    _file.fail(where, "images of at most " + std::to_string(_file.allBytes()) +
                                          " bytes together, as many as the file has");
                image.view = _accessors.bytesOf(number);
                image.format = formatOf(image.view, mime);
            } else {
                readUri(from.value("uri", ""), image);
            }
            _document.images.push_back(std::move(image));
        });
    }

    /// Decodes "my%20file.png" to "my file.png". A byte 0, which no file name contains, stays
    /// escaped. Invalid data is dropped, so that the material is drawn without the image.
    static void readUri(const std::string& uri, GltfImage& image) {
        if (!isDataUri(uri)) {
            image.uri = decodedUri(uri);
            for (std::size_t zero = 0; (zero = image.uri.find('\0', zero)) != std::string::npos;)
                image.uri.replace(zero, 1, "%00");
            return;
        }
        try {
            image.data = dataOfUri(uri);
        } catch (const Error&) {
            image.data.clear();
        }
        image.format = formatOf(image.data, uri.substr(5, uri.find_first_of(";,") - 5));
    }

    void readTextures() {
        std::vector<Texture> samplers;
        _file.forEach("samplers", [&](const json& from, const std::string& where) {
            Texture& sampler = samplers.emplace_back();
            for (const char* key : {"magFilter", "minFilter"})
                if (from.contains(key)) _file.index(from.at(key), 1 << 16, where);
            if (from.contains("wrapS"))
                sampler.wrapS = wrapOf(_file.index(from.at("wrapS"), 1 << 16, where));
            if (from.contains("wrapT"))
                sampler.wrapT = wrapOf(_file.index(from.at("wrapT"), 1 << 16, where));
        });
        _file.forEach("textures", [&](const json& from, const std::string& where) {
            Texture texture;
            GltfIndex image;
            if (const json* source = sourceOf(from))
                image = _imageOf[_file.indexOf(*source, "images", where)];
            if (from.contains("sampler"))
                texture = samplers[_file.indexOf(from.at("sampler"), "samplers", where)];
            texture.image = image;
            _textures.push_back(texture);
        });
    }

    TextureInfo textureInfo(const json& from, const std::string& where) const {
        TextureInfo info;
        info.texture = _file.indexOf(from.at("index"), "textures", where);
        if (from.contains("texCoord")) info.texCoord = _file.index(from.at("texCoord"), 8, where);
        const auto extensions = from.find("extensions");
        if (extensions == from.end()) return info;
        const auto moved = extensions->find("KHR_texture_transform");
        if (moved == extensions->end()) return info;
        GltfTextureTransform& transform = info.transform.emplace();
        const std::vector<double> offset = _file.numbers(*moved, "offset", 2, where);
        const std::vector<double> scale = _file.numbers(*moved, "scale", 2, where);
        std::copy(offset.begin(), offset.end(), transform.offset);
        std::copy(scale.begin(), scale.end(), transform.scale);
        transform.rotation = _file.number(*moved, "rotation", 0.0, where);
        if (moved->contains("texCoord"))
            info.texCoord = _file.index(moved->at("texCoord"), 8, where);
        return info;
    }

    void readMaterial(const json& from, const std::string& where) {
        std::vector<double> base{1.0, 1.0, 1.0, 1.0};
        double roughness = 1.0;
        const json* texture = nullptr;
        const auto colour = [&](const json& part, const char* key) {
            const std::vector<double> own = _file.numbers(part, key, 4, where);
            if (!own.empty()) base = own;
        };
        const auto pbr = from.find("pbrMetallicRoughness");
        if (pbr != from.end()) {
            colour(*pbr, "baseColorFactor");
            _file.number(*pbr, "metallicFactor", 1.0, where);
            roughness = _file.number(*pbr, "roughnessFactor", 1.0, where);
            texture = memberOf(*pbr, "baseColorTexture");
        }
        // Draw a surface that is black except for its emission texture with that texture.
        const std::vector<double> emissive = _file.numbers(from, "emissiveFactor", 3, where);
        const json* glow = memberOf(from, "emissiveTexture");
        const bool isBlack = base[0] == 0.0 && base[1] == 0.0 && base[2] == 0.0;
        const bool isGlowOnly =
            glow && pbr != from.end() && isBlack && !texture && !emissive.empty();
        if (isGlowOnly) {
            texture = glow;
            std::copy(emissive.begin(), emissive.end(), base.begin());
        }
        // This older extension has priority if a material has both models.
        if (const json* glossy = extensionOf(from, "KHR_materials_pbrSpecularGlossiness")) {
            base = {1.0, 1.0, 1.0, 1.0};
            colour(*glossy, "diffuseFactor");
            roughness = 1.0 - _file.number(*glossy, "glossinessFactor", 1.0, where);
            texture = memberOf(*glossy, "diffuseTexture");
            if (pbr != from.end()) _drawn.insert(&*pbr); // by other means
        }
        GltfMaterial result;
        Material& surface = result.source.material;
        result.source.isLinear = true;
        surface.diffuse = {toSrgb(float(base[0])), toSrgb(float(base[1])), toSrgb(float(base[2])),
                           static_cast<float>(base[3])};
        if (!isGlowOnly && !emissive.empty())
            surface.emission = {toSrgb(float(emissive[0])), toSrgb(float(emissive[1])),
                                toSrgb(float(emissive[2])), 1.0f};
        setRoughness(static_cast<float>(roughness), surface);
        surface.alpha = Material::Alpha::Opaque;
        if (from.contains("alphaMode")) {
            const std::string& mode = from.at("alphaMode").get_ref<const std::string&>();
            if (mode == "BLEND") surface.alpha = Material::Alpha::Blend;
            if (mode == "MASK") surface.alpha = Material::Alpha::Mask;
        }
        surface.alphaCutOff = static_cast<float>(_file.number(from, "alphaCutoff", 0.5, where));
        surface.twoSided = from.contains("doubleSided") && from.at("doubleSided").get<bool>();
        if (texture) setTexture(*texture, where, Material::Diffuse, result);
        if (!extensionOf(from, "KHR_materials_unlit")) {
            readMaps(from, where, result);
            countUnused(from);
        }
        const osg::Vec4 none = Material().emission;
        if (glow && !result.source.textures[Material::Emission].image) surface.emission = none;
        _document.materials.push_back(std::move(result));
    }

    /// Reads the textures that need shaders.
    void readMaps(const json& from, const std::string& where, GltfMaterial& material) {
        Material& surface = material.source.material;
        if (const json* bumps = memberOf(from, "normalTexture")) {
            surface.normalScale =
                static_cast<float>(_file.number(*bumps, "scale", 1.0, where + ".normalTexture"));
            setTexture(*bumps, where, Material::Normal, material);
        }
        if (const json* shade = memberOf(from, "occlusionTexture")) {
            surface.occlusionStrength = static_cast<float>(
                _file.number(*shade, "strength", 1.0, where + ".occlusionTexture"));
            setTexture(*shade, where, Material::Occlusion, material);
        }
        const json* glow = memberOf(from, "emissiveTexture");
        if (!glow || _drawn.count(glow) > 0) return;
        if (surface.emission == Material().emission)
            _drawn.insert(glow); // times black
        else
            setTexture(*glow, where, Material::Emission, material);
    }

    /// Counts the textures of a material and its extensions that are not drawn.
    void countUnused(const json& from) {
        constexpr std::string_view kTexture = "Texture";
        for (const auto& [name, part] : from.items()) {
            if (!part.is_object() || name == "extras" || _drawn.count(&part) > 0) continue;
            const bool isTexture = name.size() > kTexture.size() &&
                                   name.substr(name.size() - kTexture.size()) == kTexture;
            if (isTexture && part.contains("index"))
                ++_unused[name];
            else
                countUnused(part);
        }
    }

    static const json* memberOf(const json& from, const char* name) {
        const auto found = from.find(name);
        return found == from.end() ? nullptr : &*found;
    }

    static const json* extensionOf(const json& from, const char* name) {
        const json* extensions = memberOf(from, "extensions");
        return extensions ? memberOf(*extensions, name) : nullptr;
    }

    /// Sets one of the textures, unless it needs other texture coordinates than those before it.
    void setTexture(const json& from, const std::string& where, Material::Map map,
                    GltfMaterial& material) {
        const TextureInfo info = textureInfo(from, where);
        if (material.hasTextures &&
            !(info.texCoord == material.texCoord && info.transform == material.transform))
            return;
        const Texture& texture = _textures[info.texture];
        material.hasTextures = true;
        material.texCoord = info.texCoord;
        material.transform = info.transform;
        if (!texture.image) return;
        _drawn.insert(&from);
        material.source.textures[map] = {_document.images[*texture.image].uri, texture.image};
        material.source.material.textures[map] = {nullptr, texture.wrapS, texture.wrapT};
    }

    /// Sets the specular exponent for a highlight of the same width; a rough surface has none.
    static void setRoughness(float roughness, Material& surface) {
        surface.shininess = 2.0f / std::max(1e-6f, std::pow(roughness, 4.0f)) - 2.0f;
        if (roughness >= 1.0f) surface.specular = {0.0f, 0.0f, 0.0f, 1.0f};
    }

    GltfDocument& _document;
    GltfFile& _file;
    const GltfAccessors& _accessors;
    std::vector<std::size_t> _imageOf; ///< index in GltfDocument::images of each image
    std::vector<Texture> _textures;
    std::set<const json*> _drawn;               ///< parts of materials
    std::map<std::string, std::size_t> _unused; ///< textures, by name of the member
};

} // namespace

void readMaterials(GltfDocument& document) {
    MaterialReader(document).run();
    // The specification's default, for meshes without a material.
    GltfMaterial& last = document.materials.emplace_back();
    last.source.isLinear = true;
    last.source.material.diffuse = {1.0f, 1.0f, 1.0f, 1.0f};
    last.source.material.specular = {0.0f, 0.0f, 0.0f, 1.0f};
    last.source.material.shininess = 0.0f;
    last.source.material.alpha = Material::Alpha::Opaque;
    last.source.material.twoSided = false;
}

} // namespace osgSkin
