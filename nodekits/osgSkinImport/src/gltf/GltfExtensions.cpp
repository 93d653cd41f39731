// SPDX-License-Identifier: MIT
#include "gltf/GltfExtensions.h"

#include "text/FileText.h"

#include <osg/Notify>

#include <algorithm>

namespace osgSkin {
namespace {

/// Extensions for compressed buffer views, and what people call them.
constexpr const char* kPacked[][2] = {{"EXT_meshopt_compression", "meshopt compression"},
                                      {"KHR_meshopt_compression", "meshopt compression"},
                                      {"MESHOPT_compression", "meshopt compression"}};

/// Of required extensions, those that are read or have to do with looks only.
constexpr const char* kHarmless[] = {"KHR_draco_mesh_compression",
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

bool isHarmless(const std::string& extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* start) { return extension.rfind(start, 0) == 0; });
}

/// A packed buffer view may name a buffer with the same bytes unpacked, which need not be there.
bool hasContent(const GltfFile& file, const nlohmann::json& view) {
    const auto index = view.at("buffer").get<std::size_t>();
    const nlohmann::json& buffer = file.json.at("buffers").at(index);
    return buffer.contains("uri") || (index == 0 && file.binary.has_value());
}

} // namespace

void checkExtensions(const GltfFile& file) {
    const nlohmann::json none = nlohmann::json::array();
    for (const nlohmann::json& view : file.json.value("bufferViews", none))
        for (const auto& [extension, name] : kPacked)
            if (view.contains("extensions") && view.at("extensions").contains(extension) &&
                !hasContent(file, view))
                failFile(file.path, std::string(name) + " (" + extension +
                                        ") is not read; save the file without it");
    for (const nlohmann::json& required : file.json.value("extensionsRequired", none)) {
        const std::string extension = required.get<std::string>();
        const bool isPacked = std::any_of(std::begin(kPacked), std::end(kPacked),
                                          [&](const auto& known) { return extension == known[0]; });
        if (!isPacked && !isHarmless(extension))
            OSG_NOTICE << file.path << ": requires the extension \"" << extension
                       << "\", which is not known; read without it" << std::endl;
    }
}

bool facesBackwards(const GltfFile& file) {
    const auto extensions = file.json.find("extensions");
    return extensions != file.json.end() && extensions->contains("VRM");
}

} // namespace osgSkin
