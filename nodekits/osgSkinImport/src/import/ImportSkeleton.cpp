// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSkeleton>

#include "assimp/AssimpScene.h"
#include "assimp/SceneSkeleton.h"
#include "osg/OsgScene.h"
#include "text/BvhCheck.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

namespace osgSkin {

RestSkeleton importSkeleton(const std::string& path) {
    if (!assimpReads(path)) return skeletonOf(*readOsgScene(path, nullptr), path);
    if (osgDB::getLowerCaseFileExtension(path) == "bvh")
        checkBvh(path, readText(path));
    else
        requireReadable(path);
    Assimp::Importer importer;
    return skeletonOf(readAssimpScene(importer, path), path).rest;
}

} // namespace osgSkin
