// SPDX-License-Identifier: MIT
#include "text/SafeNames.h"

#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

namespace osgSkin {
namespace {

template <typename Names>
bool has(const Names& names, const std::string& extension) {
    return std::find(std::begin(names), std::end(names), extension) != std::end(names);
}

bool isArchive(const std::string& name) {
    static const char* const archives[] = {"7z",     "bz2",  "gz",     "ivez", "osga",
                                           "osgtgz", "osgz", "osgxgz", "ozg",  "rar",
                                           "tar",    "tgz",  "xgz",    "xz",   "zip"};
    return has(archives, osgDB::getLowerCaseFileExtension(name));
}

/// Whether OSG would open an archive on the way to a file. Folders may be called as they like.
bool leadsThroughArchive(const std::string& path) {
    std::size_t first = 0;
    for (std::size_t end = 0; (end = path.find_first_of("/\\", first)) != std::string::npos;
         first = end + 1) {
        if (!isArchive(path.substr(first, end - first))) continue;
        std::error_code ignored;
        if (!std::filesystem::is_directory(path.substr(0, end), ignored)) return true;
    }
    return false;
}

} // namespace

void requireName(const std::string& path) {
    if (path.size() > kLongestPath)
        failFile(path, "a name of " + std::to_string(path.size()) + " bytes, expected at most " +
                           std::to_string(kLongestPath));
    if (path.find('\0') != std::string::npos)
        failFile(path, "a name with a byte 0 in it, expected none");
}

bool isOnlyRead(const std::string& path) {
    static const char* const scripts[] = {"js", "lua", "py", "pyc", "python", "v8"};
    // They name more to read or run, or ask for what stands before them past our guard.
    static const char* const lists[] = {"ffmpeg",    "logo",  "normals",  "p3d",
                                        "present3d", "pview", "revisions"};
    static const char* const networks[] = {"curl", "gdal", "net", "ogr", "osc", "vnc"};
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return !isArchive(path) && !has(scripts, extension) && !has(lists, extension) &&
           !has(networks, extension) && !leadsThroughArchive(path);
}

void requireOnlyRead(const std::string& path) {
    requireName(path);
    if (isOnlyRead(path)) return;
    failFile(path, "an archive, a script or an address by its extension, expected a file that only "
                   "has to be read");
}

} // namespace osgSkin
