// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSkeleton>

#include "assimp/AssimpScene.h"
#include "assimp/SceneSkeleton.h"
#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "osg/OsgScene.h"
#include "text/FileText.h"

#include <osgSkinImport/ReadScene>

#include <osgDB/FileNameUtils>

namespace osgSkin {

RestSkeleton importSkeleton(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    if (osgDB::getLowerCaseFileExtension(path) == "bvh")
        return makeRestSkeleton(readBvh(path, limits));
    if (!assimpReads(path)) return readOsgSkeleton(*readScene(path, options), path);
    requireReadable(path, limits);
    if (holdsMeshesOnly(path))
        failFile(path, "no skeleton in files of its kind, expected one of another");
    Assimp::Importer importer;
    return readSceneSkeleton(readAssimpScene(importer, path, limits), path, limits).rest;
}

} // namespace osgSkin
