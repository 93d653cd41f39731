// SPDX-License-Identifier: MIT
#include "assimp/SceneFile.h"

#include "text/FileText.h"

#include <assimp/MemoryIOWrapper.h>

#include <cstdint>

namespace osgSkin {

bool SceneFile::Exists(const char* file) const {
    return file == _name || DefaultIOSystem::Exists(file);
}

Assimp::IOStream* SceneFile::Open(const char* file, const char* mode) {
    if (file != _name) return isRegularFile(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
    // The stream reads what this holds; the importer drops the stream first.
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(_content.data()),
                                      _content.size());
}

} // namespace osgSkin
