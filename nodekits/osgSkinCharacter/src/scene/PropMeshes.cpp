// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/PropMeshes.h"

#include <filesystem>
#include <system_error>

namespace osgSkin {

const ImportedMesh& PropMeshes::of(const std::string& file) {
    std::error_code failure;
    const std::string path = std::filesystem::weakly_canonical(file, failure).string();
    const std::string& key = failure ? file : path;
    const auto known = _meshes.find(key);
    if (known != _meshes.end()) return known->second;
    return _meshes.emplace(key, importMesh(file, _options.get())).first->second;
}

} // namespace osgSkin
