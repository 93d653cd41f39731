// SPDX-License-Identifier: GPL-3.0-or-later
#include "source/CacheFolder.h"

#include <cstdlib>
#include <filesystem>

namespace osgSkin {
namespace {

namespace fs = std::filesystem;

/// The folder that an environment variable names; the specification ignores relative ones.
fs::path folderFrom(const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path folder = value == nullptr ? "" : value;
    return folder.is_absolute() ? folder : fs::path();
}

} // namespace

std::string cacheFolder() {
    fs::path base = folderFrom("XDG_CACHE_HOME");
    if (base.empty()) {
        base = folderFrom("HOME");
        if (base.empty()) return {};
        base /= ".cache";
    }
    return (base / "osgSkin").string();
}

} // namespace osgSkin
