// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMesh>

#include "files/FileFormat.h"
#include "files/FileText.h"
#include "import/ShareScenes.h"
#include "mesh/FinishMesh.h"
#include "mesh/MeshFiles.h"
#include "osg/OsgScene.h"
#include "scene/SceneMesh.h"

#include <new>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

CornerMesh readMesh(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    CornerMesh result;
    switch (formatOf(path).reader) {
    case FileFormat::Obj: // Assimp's and OSG's OBJ readers reorder the vertices
        result = readObjMesh(path, options);
        break;
    case FileFormat::Ply:
        result = readPlyMesh(path, options);
        break;
    case FileFormat::Off:
        result = readOffMesh(path, options);
        break;
    case FileFormat::Bvh:
        refuse(path, limits, "BVH files have no mesh");
    case FileFormat::Character:
        failFile(path, "a character, expected a mesh: name the file that its \"mesh\" names");
    case FileFormat::Osg:
        return readOsgMesh(path, options);
    default:
        return readSceneMesh(*readSourceScene(path, options), path, options);
    }
    checkVertices(result, path, limits);
    return result;
}

} // namespace

ImportedMesh importMesh(const std::string& path, const osgDB::Options* options) try {
    CornerMesh read = readMesh(path, options);
    checkMaterials(read, path, ReadLimits::of(options));
    return finishMesh(std::move(read), path, ReadLimits::of(options));
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

double importUnit(const std::string& path, const osgDB::Options* options) {
    return formatOf(path).isScene() ? readSourceScene(path, options)->metresPerUnit : 0.0;
}

} // namespace osgSkin
