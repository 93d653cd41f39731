// SPDX-License-Identifier: MIT
#include "gltf/GltfExtensions.h"

#include <osg/Notify>

#include <algorithm>

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

bool isHarmless(const std::string& extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* start) { return extension.rfind(start, 0) == 0; });
}

} // namespace

void noteExtensions(const GltfFile& file) {
    const nlohmann::json none = nlohmann::json::array();
    for (const nlohmann::json& required : file.json.value("extensionsRequired", none)) {
        const std::string extension = required.get<std::string>();
        if (!isHarmless(extension))
            OSG_NOTICE << file.path << ": requires the extension \"" << extension
                       << "\", which is not known; read without it" << std::endl;
    }
}

bool facesBackwards(const GltfFile& file) {
    const auto extensions = file.json.find("extensions");
    return extensions != file.json.end() && extensions->contains("VRM");
}

} // namespace osgSkin
