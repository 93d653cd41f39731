// SPDX-License-Identifier: MIT
#include <osgSkinImport/FindNamedFile>

#include <osgDB/FileUtils>
#include <osgDB/Registry>

namespace osgSkin {

std::string findNamedFile(const std::string& name, const osgDB::Options* options) {
    osgDB::Registry& registry = *osgDB::Registry::instance();
    const bool asTheApplicationSays =
        (options != nullptr && options->getFindFileCallback() != nullptr) ||
        registry.getFindFileCallback() != nullptr;
    if (asTheApplicationSays) return osgDB::findDataFile(name, options);
    if (name.empty() || osgDB::fileExists(name)) return name;
    std::string found;
    if (options != nullptr) found = osgDB::findFileInPath(name, options->getDatabasePathList());
    return found.empty() ? osgDB::findFileInPath(name, registry.getDataFilePathList()) : found;
}

} // namespace osgSkin
