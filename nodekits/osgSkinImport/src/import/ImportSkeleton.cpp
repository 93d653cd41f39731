// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSkeleton>

#include "assimp/AssimpScene.h"
#include "assimp/SceneSkeleton.h"
#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "osg/OsgScene.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

namespace osgSkin {

RestSkeleton importSkeleton(const std::string& path, const osgDB::Options* options) {
    if (osgDB::getLowerCaseFileExtension(path) == "bvh") return makeRestSkeleton(readBvh(path));
    if (!assimpReads(path)) return readOsgSkeleton(*readOsgScene(path, options), path);
    requireReadable(path);
    Assimp::Importer importer;
    return readSceneSkeleton(readAssimpScene(importer, path), path).rest;
}

} // namespace osgSkin
