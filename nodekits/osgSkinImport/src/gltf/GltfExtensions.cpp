// SPDX-License-Identifier: MIT
#include "gltf/GltfExtensions.h"

#include "text/FileText.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Of required extensions, those that are read or have to do with looks only.
constexpr const char* kHarmless[] = {"KHR_draco_mesh_compression",
                                     "EXT_meshopt_compression",
                                     "KHR_meshopt_compression",
                                     "MESHOPT_compression",
                                     "KHR_mesh_quantization",
                                     "KHR_materials_",
                                     "KHR_texture_",
                                     "KHR_lights_",
                                     "EXT_texture_",
                                     "EXT_lights_",
                                     "MSFT_",
                                     "KHR_xmp",
                                     "VRM",
                                     "KHR_techniques",
                                     "AGI_"};

/// Of extensions that need not be required, those that say where things stand or how they move.
constexpr const char* kMissed[] = {"KHR_animation_pointer", "EXT_mesh_gpu_instancing",
                                   "KHR_node_visibility"};

bool isHarmless(const std::string& extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* start) { return extension.rfind(start, 0) == 0; });
}

/// The texture that a primitive's surface is coloured by; null where there is none.
const nlohmann::json* textureOf(const nlohmann::json& gltf, const nlohmann::json& primitive) {
    if (!primitive.contains("material")) return nullptr;
    const nlohmann::json& material =
        gltf.at("materials").at(primitive.at("material").get<std::size_t>());
    const auto pbr = material.find("pbrMetallicRoughness");
    if (pbr == material.end() || !pbr->contains("baseColorTexture")) return nullptr;
    return &pbr->at("baseColorTexture");
}

/// Scaled, turned and moved, in the file's texture space: v goes down, and the turn is
/// counter-clockwise where it is looked at.
void moveEach(const nlohmann::json& transform, std::vector<double>& texCoords) {
    const auto offset = transform.value("offset", std::vector<double>{0.0, 0.0});
    const auto scale = transform.value("scale", std::vector<double>{1.0, 1.0});
    const double turn = transform.value("rotation", 0.0);
    const double cosine = std::cos(turn), sine = std::sin(turn);
    for (std::size_t i = 0; i + 1 < texCoords.size(); i += 2) {
        const double u = scale[0] * texCoords[i], v = scale[1] * texCoords[i + 1];
        texCoords[i] = offset[0] + cosine * u + sine * v;
        texCoords[i + 1] = offset[1] - sine * u + cosine * v;
    }
}

} // namespace

void moveTexCoords(GltfFile& file, GltfAccessors& accessors) {
    if (!file.json.contains("meshes")) return;
    std::map<std::pair<std::size_t, nlohmann::json>, std::size_t> moved; // what several share
    bool isCompressed = false;
    for (nlohmann::json& mesh : file.json.at("meshes"))
        for (nlohmann::json& primitive : mesh.at("primitives")) {
            const nlohmann::json* const texture = textureOf(file.json, primitive);
            if (texture == nullptr || !texture->contains("extensions")) continue;
            const nlohmann::json transform = texture->at("extensions").at("KHR_texture_transform");
            const std::string name = "TEXCOORD_" + std::to_string(texture->value("texCoord", 0));
            nlohmann::json& attributes = primitive.at("attributes");
            if (!attributes.contains(name)) continue;
            const auto own = attributes.at(name).get<std::size_t>();
            if (primitive.contains("extensions") && !accessors.hasValues(own)) {
                isCompressed = true;
                continue;
            }
            const auto [entry, isNew] = moved.emplace(std::make_pair(own, transform), 0);
            if (isNew) {
                std::vector<double> texCoords = accessors.values(own);
                moveEach(transform, texCoords);
                entry->second = accessors.add("VEC2", texCoords);
            }
            attributes[name] = entry->second;
        }
    if (isCompressed)
        tellOf(file.path, "textures are moved on meshes compressed by Draco, which is not read");
}

void noteExtensions(const GltfFile& file) {
    const nlohmann::json none = nlohmann::json::array();
    const nlohmann::json required = file.json.value("extensionsRequired", none);
    std::set<std::string> unknown;
    for (const nlohmann::json& entry : required)
        if (!isHarmless(entry.get_ref<const std::string&>()))
            unknown.insert(entry.get<std::string>());
    if (unknown.size() == 1)
        tellOf(file.path, "requires the extension " + inQuotes(*unknown.begin()) +
                              ", which is not known; read without it");
    if (unknown.size() > 1)
        tellOf(file.path, "requires " + std::to_string(unknown.size()) + " extensions, " +
                              inQuotes(*unknown.begin()) +
                              " among them, which are not known; read without them");
    const nlohmann::json used = file.json.value("extensionsUsed", none);
    for (const char* missed : kMissed)
        if (std::find(used.begin(), used.end(), missed) != used.end() &&
            std::find(required.begin(), required.end(), missed) == required.end())
            tellOf(file.path, std::string("uses the extension \"") + missed +
                                  "\", which is not known; read without it");
}

bool facesBackwards(const GltfFile& file) {
    const auto extensions = file.json.find("extensions");
    return extensions != file.json.end() && extensions->contains("VRM");
}

} // namespace osgSkin
