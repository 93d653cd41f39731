// SPDX-License-Identifier: MIT
#include "text/SafeNames.h"

#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <iterator>

namespace osgSkin {

bool isOnlyRead(const std::string& path) {
    static const char* const archives[] = {"7z",     "bz2",  "gz",     "ivez", "osga",
                                           "osgtgz", "osgz", "osgxgz", "ozg",  "rar",
                                           "tar",    "tgz",  "xgz",    "xz",   "zip"};
    static const char* const scripts[] = {"js", "lua", "py", "pyc", "python", "v8"};
    // They name more to read or run.
    static const char* const lists[] = {"p3d", "present3d", "pview", "revisions"};
    static const char* const networks[] = {"curl", "gdal", "net", "ogr", "osc", "vnc"};
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    const auto has = [&](const auto& names) {
        return std::find(std::begin(names), std::end(names), extension) != std::end(names);
    };
    return !has(archives) && !has(scripts) && !has(lists) && !has(networks);
}

void requireOnlyRead(const std::string& path) {
    if (isOnlyRead(path)) return;
    failFile(path, "an archive, a script or an address by its extension, expected a file that only "
                   "has to be read");
}

} // namespace osgSkin
