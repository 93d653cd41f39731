// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSkeleton>

#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "import/ShareScenes.h"
#include "osg/OsgScene.h"
#include "scene/SceneSkeleton.h"
#include "text/FileText.h"

#include <osgSkinImport/ReadScene>

#include <osgDB/FileNameUtils>

#include <new>

namespace osgSkin {

RestSkeleton importSkeleton(const std::string& path, const osgDB::Options* options) try {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    if (osgDB::getLowerCaseFileExtension(path) == "bvh")
        return makeRestSkeleton(readBvh(path, limits));
    if (!hasSceneReader(path)) return readOsgSkeleton(*readScene(path, options), path);
    if (holdsMeshesOnly(path)) {
        requireReadable(path, limits);
        failFile(path, "files of this format have no skeleton; expected one of another format");
    }
    const std::shared_ptr<const SourceScene> scene = readSourceScene(path, options);
    return readSceneSkeleton(*scene, path, limits).rest;
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

} // namespace osgSkin
