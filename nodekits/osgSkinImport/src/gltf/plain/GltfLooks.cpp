// SPDX-License-Identifier: MIT
#include "gltf/plain/GltfLooks.h"

#include "gltf/Uri.h"
#include "text/Base64.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

bool isWord(const std::string& text) {
    return text.size() <= 40 && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '/' || c == '-' ||
                      c == '+' || c == '.';
           });
}

/// The kind of picture that bytes begin as, which exporters name wrongly or not at all; `otherwise`
/// where it is none of these.
std::string mimeOf(std::string_view bytes, const std::string& otherwise) {
    static const std::pair<std::string_view, const char*> kinds[] = {{"\x89PNG", "image/png"},
                                                                     {"\xff\xd8\xff", "image/jpeg"},
                                                                     {"GIF8", "image/gif"},
                                                                     {"DDS ", "image/dds"},
                                                                     {"BM", "image/bmp"}};
    for (const auto& [mark, mime] : kinds)
        if (bytes.substr(0, mark.size()) == mark) return mime;
    return isWord(otherwise) ? otherwise : "";
}

/// An image's data in base64. What is none is drawn without, as is any picture that is broken.
std::string plainData(const std::string& uri) {
    const std::string kind = uri.substr(5, uri.find_first_of(";,") - 5);
    std::string bytes;
    try {
        bytes = dataOfUri(uri);
    } catch (const Error&) {
        bytes.clear();
    }
    return "data:" + mimeOf(bytes, kind) + ";base64," + toBase64(bytes);
}

/// Where an image stands that a texture has by an extension, for those who read its format; null
/// where there is none.
const json* sourceOf(const json& texture) {
    const auto own = texture.find("source");
    if (own != texture.end()) return &*own;
    const auto extensions = texture.find("extensions");
    if (extensions == texture.end()) return nullptr;
    for (const json& extension : *extensions)
        if (extension.contains("source")) return &extension.at("source");
    return nullptr;
}

} // namespace

GltfLooks::GltfLooks(const GltfParts& parts) : _parts(parts) {}

json GltfLooks::textureInfo(const json& from, const std::string& where) const {
    json info = {{"index", _parts.indexOf(from.at("index"), "textures", where)}};
    if (from.contains("texCoord")) info["texCoord"] = _parts.index(from.at("texCoord"), 8, where);
    const json none = json::object();
    const json extensions = from.value("extensions", none);
    const auto moved = extensions.find("KHR_texture_transform");
    if (moved == extensions.end()) return info;
    json& to = info["extensions"]["KHR_texture_transform"] = json::object();
    _parts.copyNumbers(*moved, "offset", 2, where, to);
    _parts.copyNumbers(*moved, "scale", 2, where, to);
    _parts.copyNumber(*moved, "rotation", where, to);
    if (moved->contains("texCoord"))
        info["texCoord"] = _parts.index(moved->at("texCoord"), 8, where);
    return info;
}

json GltfLooks::material(const json& from, const std::string& where) const {
    json result = json::object();
    _parts.copyName(from, result);
    if (from.contains("pbrMetallicRoughness")) {
        const json& pbr = from.at("pbrMetallicRoughness");
        json& to = result["pbrMetallicRoughness"] = json::object();
        _parts.copyNumbers(pbr, "baseColorFactor", 4, where, to);
        _parts.copyNumber(pbr, "metallicFactor", where, to);
        _parts.copyNumber(pbr, "roughnessFactor", where, to);
        if (pbr.contains("baseColorTexture"))
            to["baseColorTexture"] = textureInfo(pbr.at("baseColorTexture"), where);
    }
    if (from.contains("emissiveTexture"))
        glow(from, where, result);
    else
        _parts.copyNumbers(from, "emissiveFactor", 3, where, result);
    if (from.contains("alphaMode") && isWord(osgDB::convertToLowerCase(from.at("alphaMode"))))
        result["alphaMode"] = from.at("alphaMode");
    _parts.copyNumber(from, "alphaCutoff", where, result);
    if (from.contains("doubleSided")) result["doubleSided"] = from.at("doubleSided").get<bool>();
    const json none = json::object();
    const json extensions = from.value("extensions", none);
    // An older way to say what a surface is like, which goes before the other where both are there.
    const auto glossy = extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (glossy != extensions.end()) {
        json checked = json::object();
        _parts.copyNumbers(*glossy, "diffuseFactor", 4, where, checked);
        _parts.copyNumber(*glossy, "glossinessFactor", where, checked);
        json& to = result["pbrMetallicRoughness"] = {
            {"metallicFactor", 0.0},
            {"roughnessFactor", 1.0 - checked.value("glossinessFactor", 1.0)}};
        if (checked.contains("diffuseFactor")) to["baseColorFactor"] = checked["diffuseFactor"];
        if (glossy->contains("diffuseTexture"))
            to["baseColorTexture"] = textureInfo(glossy->at("diffuseTexture"), where);
    }
    if (extensions.contains("KHR_materials_unlit"))
        result["extensions"]["KHR_materials_unlit"] = json::object();
    return result;
}

void GltfLooks::glow(const json& from, const std::string& where, json& result) const {
    const json info = textureInfo(from.at("emissiveTexture"), where);
    json checked = json::object();
    _parts.copyNumbers(from, "emissiveFactor", 3, where, checked);
    if (!result.contains("pbrMetallicRoughness")) return;
    json& pbr = result.at("pbrMetallicRoughness");
    const json base = pbr.value("baseColorFactor", json::array({1.0, 1.0, 1.0, 1.0}));
    const bool isBlack = base.at(0) == 0.0 && base.at(1) == 0.0 && base.at(2) == 0.0;
    if (!isBlack || pbr.contains("baseColorTexture") || !checked.contains("emissiveFactor")) return;
    pbr["baseColorTexture"] = info;
    for (std::size_t k = 0; k < 3; ++k)
        pbr["baseColorFactor"][k] = checked.at("emissiveFactor").at(k);
}

std::vector<std::size_t> GltfLooks::addImages(json& result) const {
    // Assimp copies the bytes of each image, however many stand in the same place.
    std::map<std::array<std::size_t, 3>, std::size_t> stored; // by buffer, offset and length
    std::size_t bytes = 0;
    std::vector<std::size_t> places;
    _parts.forEach("images", [&](const json& from, const std::string& where) {
        json image = json::object();
        _parts.copyName(from, image);
        std::string mime = from.value("mimeType", "");
        places.push_back(result["images"].size());
        if (from.contains("bufferView")) {
            const std::string wrong = _parts.beyondView(from.at("bufferView"), 0, 0, 0, true);
            if (!wrong.empty()) _parts.fail(where, wrong);
            const std::size_t number = from.at("bufferView").get<std::size_t>();
            const json& view = result.at("bufferViews").at(number);
            const std::size_t length = view.at("byteLength").get<std::size_t>();
            const auto [found, isNew] =
                stored.insert({{view.at("buffer").get<std::size_t>(),
                                view.at("byteOffset").get<std::size_t>(), length},
                               places.back()});
            places.back() = found->second;
            if (!isNew) return;
            bytes += length;
            if (bytes > _parts.bytes())
                _parts.fail(where, "images of at most " + std::to_string(_parts.bytes()) +
                                       " bytes together, as many as the file has");
            mime = mimeOf(_parts.bytesOf(from.at("bufferView")), mime);
            image["bufferView"] = number;
            image["mimeType"] = mime.empty() ? "image/unknown" : mime; // there must be one
        } else {
            const std::string uri = from.value("uri", "");
            image["uri"] = isDataUri(uri) ? plainData(uri) : uri;
        }
        result["images"].push_back(image);
    });
    return places;
}

void GltfLooks::check(json& result) const {
    const std::vector<std::size_t> images = addImages(result);
    _parts.forEach("samplers", [&](const json& from, const std::string& where) {
        json sampler = json::object();
        for (const char* key : {"magFilter", "minFilter", "wrapS", "wrapT"})
            if (from.contains(key)) sampler[key] = _parts.index(from.at(key), 1 << 16, where);
        result["samplers"].push_back(sampler);
    });
    _parts.forEach("textures", [&](const json& from, const std::string& where) {
        json texture = json::object();
        if (const json* source = sourceOf(from))
            texture["source"] = images[_parts.indexOf(*source, "images", where)];
        if (from.contains("sampler"))
            texture["sampler"] = _parts.indexOf(from.at("sampler"), "samplers", where);
        result["textures"].push_back(texture);
    });
    std::size_t glowing = 0;
    _parts.forEach("materials", [&](const json& from, const std::string& where) {
        result["materials"].push_back(material(from, where));
        const json none = json::object();
        const bool isColour =
            result["materials"]
                .back()
                .value("pbrMetallicRoughness", none)
                .contains("baseColorTexture") &&
            !from.value("pbrMetallicRoughness", none).contains("baseColorTexture");
        if (from.contains("emissiveTexture") && !isColour) ++glowing;
    });
    if (glowing > 0)
        tellOf(_parts.path(), "textures of emission: " + std::to_string(glowing) +
                                  ", left out, and that surfaces glow with them");
}

} // namespace osgSkin
