// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSkeleton>

#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "files/FileFormat.h"
#include "files/FileText.h"
#include "import/ShareScenes.h"
#include "osg/OsgScene.h"
#include "scene/SceneSkeleton.h"

#include <osgSkinImport/ReadScene>

#include <new>

namespace osgSkin {

RestSkeleton importSkeleton(const std::string& path, const osgDB::Options* options) try {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const FileFormat format = formatOf(path);
    if (format.reader == FileFormat::Bvh) return makeRestSkeleton(readBvh(path, limits));
    if (format.reader >= FileFormat::Osg) return readOsgSkeleton(*readScene(path, options), path);
    if (!format.hasSkeleton)
        refuse(path, limits,
               "files of this format have no skeleton; expected one of another format");
    const std::shared_ptr<const SourceScene> scene = readSourceScene(path, options);
    return readSceneSkeleton(*scene, path, limits).rest;
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

} // namespace osgSkin
