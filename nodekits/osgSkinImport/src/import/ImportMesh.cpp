// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMesh>

#include "import/ShareScenes.h"
#include "mesh/FinishMesh.h"
#include "mesh/MeshFiles.h"
#include "osg/OsgScene.h"
#include "scene/SceneMesh.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <new>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

CornerMesh readOwn(const std::string& format, const std::string& path,
                   const osgDB::Options* options) {
    // Assimp's and OSG's OBJ readers reorder the vertices.
    CornerMesh result = format == "obj"   ? readObjMesh(path, options)
                        : format == "off" ? readOffMesh(path, options)
                                          : readPlyMesh(path, options);
    checkVertices(result, path, ReadLimits::of(options));
    return result;
}

CornerMesh readMesh(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const std::string format = osgDB::getLowerCaseFileExtension(path);
    if (format == "skin")
        failFile(path, "a character, expected a mesh: name the file that its \"mesh\" names");
    if (format == "obj" || format == "off" || format == "ply")
        return readOwn(format, path, options);
    if (!hasSceneReader(path)) return readOsgMesh(path, options);
    return readSceneMesh(*readSourceScene(path, options), path, options);
}

} // namespace

ImportedMesh importMesh(const std::string& path, const osgDB::Options* options) try {
    CornerMesh read = readMesh(path, options);
    checkMaterials(read, path, ReadLimits::of(options));
    return finishMesh(std::move(read), path);
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

double importUnit(const std::string& path, const osgDB::Options* options) {
    const bool isScene = hasSceneReader(path) && !holdsMeshesOnly(path) &&
                         osgDB::getLowerCaseFileExtension(path) != "bvh";
    return isScene ? readSourceScene(path, options)->metresPerUnit : 0.0;
}

} // namespace osgSkin
