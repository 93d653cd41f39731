// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMesh>

#include "assimp/AssimpScene.h"
#include "assimp/mesh/AssimpMesh.h"
#include "mesh/FinishMesh.h"
#include "mesh/ObjMesh.h"
#include "mesh/PlyMesh.h"
#include "off/OffMesh.h"
#include "osg/OsgMesh.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <string>
#include <utility>

namespace osgSkin {
namespace {

CornerMesh readMesh(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const std::string format = osgDB::getLowerCaseFileExtension(path);
    if (format == "skin")
        failFile(path, "a character, expected a mesh: name the file that its \"mesh\" names");
    // Assimp's and OSG's OBJ readers reorder the vertices.
    if (format == "obj") return readObjMesh(path, options);
    if (format == "off") return readOffMesh(path, options);
    if (format == "ply") return readPlyMesh(path, options);
    if (!assimpReads(path)) return readOsgMesh(path, options);
    return readAssimpMesh(path, options);
}

} // namespace

ImportedMesh importMesh(const std::string& path, const osgDB::Options* options) {
    CornerMesh read = readMesh(path, options);
    checkMaterials(read, path, ReadLimits::of(options));
    return finishMesh(std::move(read), path);
}

} // namespace osgSkin
